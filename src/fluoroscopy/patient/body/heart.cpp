#include "fluoroscopy/patient/body/anatomy_parts.h"

namespace endovascular_sim::fluoroscopy::body
{
namespace
{

/** Rotation whose first column points along @p axis. */
Eigen::Matrix3f axesAlong(const Point& axis)
{
  Eigen::Matrix3f axes;
  axes.col(0) = axis.normalized();
  axes.col(1) = Point::UnitZ().cross(axes.col(0)).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

}  // namespace

void addHeart(BodyPlan& plan)
{
  BodyPart chambers{tissue(kBlood, 2.0F), {}, {}};
  chambers.solids.push_back(
      ellipsoid(Point(38, -42, 146), Point(66, 44, 44), axesAlong(Point(0.70F, -0.50F, -0.50F))));  // left ventricle
  chambers.solids.push_back(
      ellipsoid(Point(16, -58, 140), Point(58, 32, 40), axesAlong(Point(0.80F, -0.20F, -0.55F))));  // right ventricle
  chambers.solids.push_back(ellipsoid(Point(-22, -26, 152), Point(29, 32, 42)));                    // right atrium
  chambers.solids.push_back(ellipsoid(Point(8, 12, 180), Point(42, 23, 28)));                       // left atrium
  plan.push_back(chambers);

  BodyPart vessels{tissue(kBlood, 1.5F), {}, {}};
  addChain(vessels.solids, {{Point(14, -44, 182), 16.0F},
                            {Point(24, -28, 212), 14.5F},
                            {Point(24, -8, 232), 12.5F},
                            {Point(38, 14, 240), 10.0F}});
  addChain(vessels.solids, {{Point(22, -8, 230), 11.0F}, {Point(-22, 8, 236), 10.0F}, {Point(-42, 14, 234), 8.0F}});
  addChain(vessels.solids, {{Point(-26, -14, 350), 8.0F},
                            {Point(-29, -8, 300), 9.5F},
                            {Point(-27, -16, 190), 10.5F}});                                // superior vena cava
  addChain(vessels.solids, {{Point(-26, -10, 160), 12.0F}, {Point(-24, 10, 110), 11.5F}});  // inferior vena cava
  addChain(vessels.solids, {{Point(26, -14, 350), 7.0F}, {Point(0, -26, 322), 7.0F}, {Point(-27, -14, 306), 8.0F}});
  plan.push_back(vessels);
}

}  // namespace endovascular_sim::fluoroscopy::body
