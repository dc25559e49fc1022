#include "patient/body/anatomy_parts.h"
#include "patient/body/hip_joint.h"

namespace endovascular_sim::patient
{

void addFemurs(BodyPlan& plan)
{
  for (const float side : {1.0F, -1.0F})
  {
    const Point head(side * kHipX, kHipY, kHipZ);
    const auto at = [&](float x, float y, float z) { return Point(side * x, y, z); };
    BodyPart upper{bone(1450.0F, 1.5F, 300.0F), {}, {}};
    upper.solids.push_back(ellipsoid(head, Point::Constant(kHeadRadius)));
    upper.solids.push_back(capsule(head, at(130, 8, -208), 16.0F, 17.0F));
    upper.solids.push_back(ellipsoid(at(145, 14, -194), Point(13, 18, 20)));
    upper.solids.push_back(capsule(at(138, 10, -206), at(136, 10, -226), 16.0F, 17.0F));
    upper.solids.push_back(ellipsoid(at(119, 24, -234), Point(9, 9, 11)));
    plan.push_back(upper);
    plan.push_back({bone(1650.0F, 5.0F, 30.0F), {capsule(at(136, 10, -226), at(122, 6, -400), 17.0F, 14.0F)}, {}});
  }
}

}  // namespace endovascular_sim::patient
