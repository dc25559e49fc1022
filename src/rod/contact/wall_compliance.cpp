#include "rod/contact/wall_compliance.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kRigidDepth = 40e-6;   // m
constexpr double kLeastCover = 0.1e-3;  // m of the wire's radius that remains in the lumen

}  // namespace

double softWallTravel(double radius)
{
  return std::max(0.5 * radius, radius - kLeastCover);
}

double stiffLayerDepth(const contact::Feature& feature, const Discretisation& rod)
{
  return std::isfinite(feature.stiffness) ? softWallTravel(wireRadiusAt(feature, rod)) : kRigidDepth;
}

void removeStiffLayer(std::vector<contact::Feature>& features)
{
  features.erase(std::remove_if(features.begin(), features.end(), isStiffLayer), features.end());
}

}  // namespace endovascular_sim::rod
