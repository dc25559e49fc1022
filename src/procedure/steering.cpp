#include "procedure/steering.h"

#include <cmath>

#include <Eigen/Geometry>

namespace endovascular_sim::procedure
{
namespace
{

constexpr double kOffAxis = 0.17;  // smallest sine of the angle between the shaft and a direction

}  // namespace

double turnTowards(const TipBend& bend, const Eigen::Vector3d& tip, const Eigen::Vector3d& target)
{
  const auto across = [&bend](const Eigen::Vector3d& direction)
  { return Eigen::Vector3d(direction - direction.dot(bend.shaft) * bend.shaft); };
  const Eigen::Vector3d to_tip = tip - bend.base;
  const Eigen::Vector3d to_target = target - bend.base;
  const Eigen::Vector3d now = across(to_tip);
  const Eigen::Vector3d wanted = across(to_target);
  if (now.norm() <= kOffAxis * to_tip.norm() || wanted.norm() <= kOffAxis * to_target.norm())
    return 0.0;
  return std::atan2(bend.shaft.dot(now.cross(wanted)), now.dot(wanted));
}

}  // namespace endovascular_sim::procedure
