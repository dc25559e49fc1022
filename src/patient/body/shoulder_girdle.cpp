#include <cmath>

#include "patient/body/anatomy_parts.h"

namespace endovascular_sim::patient
{
namespace
{

void addClavicle(BodyPlan& plan, float side)
{
  BodyPart part{bone(1500.0F, 1.6F, 250.0F), {}, {}};
  std::vector<std::pair<Point, float>> points;
  for (int i = 0; i <= 16; ++i)
  {
    const float t = static_cast<float>(i) / 16.0F;
    const float sway = std::sin(6.2831853F * t);
    points.emplace_back(
        Point(side * (19.0F + 130.0F * t), -64.0F + 78.0F * t - 15.0F * sway, 346.0F + 20.0F * t + 3.0F * sway),
        t < 0.12F ? 7.5F : 5.2F + 1.5F * t);
  }
  addChain(part.solids, points);
  plan.push_back(part);
}

void addScapula(BodyPlan& plan, float side)
{
  BodyPart part{bone(1350.0F, 1.0F, 350.0F), {}, {}};
  const Point upper(side * 78, 92, 350), glenoid(side * 148, 48, 332), lower(side * 100, 96, 222);
  part.solids.push_back(plate(upper, glenoid, lower, 1.2F));
  part.solids.push_back(capsule(upper, lower, 2.6F, 4.0F));
  part.solids.push_back(capsule(glenoid, lower, 5.5F, 4.0F));
  part.solids.push_back(capsule(upper, glenoid, 2.6F, 4.0F));
  part.solids.push_back(ellipsoid(glenoid, Point(7, 11, 17)));
  const Point acromion(side * 166, 42, 366);
  part.solids.push_back(capsule(Point(side * 84, 98, 330), Point(side * 140, 72, 352), 3.0F, 5.0F));
  part.solids.push_back(capsule(Point(side * 140, 72, 352), acromion, 5.0F, 6.5F));
  part.solids.push_back(
      capsule(glenoid + Point(-side * 8, -8, 14), Point(side * 138, 8, 348), 5.0F, 5.0F));  // coracoid
  plan.push_back(part);
}

void addHumerus(BodyPlan& plan, float side)
{
  BodyPart part{bone(1400.0F, 1.4F, 260.0F), {}, {}};
  part.solids.push_back(ellipsoid(Point(side * 171, 38, 333), Point(23, 23, 23)));
  part.solids.push_back(capsule(Point(side * 176, 36, 322), Point(side * 184, 34, 270), 19.0F, 13.0F));
  plan.push_back(part);
}

}  // namespace

void addShoulderGirdle(BodyPlan& plan)
{
  for (const float side : {1.0F, -1.0F})
  {
    addClavicle(plan, side);
    addScapula(plan, side);
    addHumerus(plan, side);
  }
}

}  // namespace endovascular_sim::patient
