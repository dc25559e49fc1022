#include "fluoroscopy/motion/body_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/** Parameters at which a line is within something. */
struct Interval
{
  double begin = -kInfinity, end = kInfinity;
};

Interval insideBall(const motion::Fade& fade, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction)
{
  const Eigen::Vector3d from = origin - fade.centre;
  const double a = direction.squaredNorm(), b = from.dot(direction);
  const double root = b * b - a * (from.squaredNorm() - fade.reach * fade.reach);
  if (!(root > 0.0))
    return {kInfinity, -kInfinity};
  return {(-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a};
}

Interval insideBox(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction)
{
  Interval inside;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double low = box.min()[axis] - origin[axis], high = box.max()[axis] - origin[axis];
    const double d = direction[axis];
    if (d == 0.0 && (low > 0.0 || high < 0.0))
      return {kInfinity, -kInfinity};
    if (d == 0.0)
      continue;
    inside.begin = std::max(inside.begin, std::min(low / d, high / d));
    inside.end = std::min(inside.end, std::max(low / d, high / d));
  }
  return inside;
}

bool equalFields(const motion::MotionField& a, const motion::MotionField& b)
{
  return a.shift == b.shift && a.linear == b.linear && a.twist == b.twist;
}

}  // namespace

BodyMotion::BodyMotion() : BodyMotion(motion::MotionMap({}, {}, {}), 0.0) {}

BodyMotion::BodyMotion(const motion::MotionMap& map, double diaphragm)
  : map_(map), diaphragm_(diaphragm), field_(map.frame())
{
}

Eigen::Vector3d BodyMotion::pullBack(const Eigen::Vector3d& moved) const
{
  Eigen::Vector3d rest = map_.pullBack(moved);
  if (diaphragm_ != 0.0)
    rest.z() += diaphragm_ * field_.weight(rest);
  return rest;
}

void BodyMotion::pullBack(const std::vector<Eigen::Vector3d>& moved, std::vector<Eigen::Vector3d>& rest) const
{
  map_.pullBack(moved, rest);
  if (diaphragm_ == 0.0)
    return;
  for (Eigen::Vector3d& point : rest)
    point.z() += diaphragm_ * field_.weight(point);
}

Eigen::AlignedBox3d BodyMotion::box() const
{
  const motion::Fade& fade = map_.frame().fade;
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(fade.reach);
  Eigen::AlignedBox3d box(fade.centre - reach, fade.centre + reach);
  for (const DiaphragmField::Dome& dome : field_.domes())
    box.extend(dome.box());
  return box;
}

bool BodyMotion::clip(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double& begin, double& end) const
{
  begin = kInfinity, end = -kInfinity;
  const auto include = [&](const Interval& part)
  {
    if (!(part.begin < part.end))
      return;
    begin = std::min(begin, part.begin);
    end = std::max(end, part.end);
  };
  include(insideBall(map_.frame().fade, origin, direction));
  for (const DiaphragmField::Dome& dome : field_.domes())
    include(insideBox(dome.box(), origin, direction));
  return begin < end;
}

bool sameRegion(const motion::HeartFrame& a, const motion::HeartFrame& b)
{
  return a.base == b.base && a.axis == b.axis && a.length == b.length && a.fade.centre == b.fade.centre &&
         a.fade.core == b.fade.core && a.fade.reach == b.fade.reach;
}

bool operator==(const BodyMotion& a, const BodyMotion& b)
{
  return a.diaphragm() == b.diaphragm() && equalFields(a.map().field(), b.map().field()) &&
         sameRegion(a.map().frame(), b.map().frame());
}

}  // namespace endovascular_sim::fluoroscopy
