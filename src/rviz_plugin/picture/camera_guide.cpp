#include "rviz_plugin/picture/camera_guide.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "common/units.h"
#include "rviz_plugin/model/message_points.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

constexpr double kRate = 6.0;             ///< natural frequency of the camera's motion [rad/s]
constexpr double kTipDistance = 0.08;     ///< of the camera from the tip [m]
constexpr double kDistanceBehind = 0.05;  ///< of the camera behind the tip, along the wire [m]
constexpr double kRim = 1.08;             ///< picture relative to the vessel
constexpr double kSteepest = 85.0 * units::kDegree;

/** Direction from the focus to the camera. */
Eigen::Vector3d directionOf(const ViewSetting& setting)
{
  const double pitch = std::clamp(setting.pitch, -kSteepest, kSteepest);
  return {std::cos(pitch) * std::sin(setting.yaw), -std::cos(pitch) * std::cos(setting.yaw), std::sin(pitch)};
}

/** Part of a vector that is normal to a direction, as a unit vector; any normal if there is none. */
Eigen::Vector3d normalPart(const Eigen::Vector3d& vector, const Eigen::Vector3d& direction)
{
  const Eigen::Vector3d part = vector - vector.dot(direction) * direction;
  return part.norm() > 1e-6 ? part.normalized() : direction.unitOrthogonal();
}

/** Point at a distance before the end of a line, along it. */
Eigen::Vector3d pointBeforeEnd(const std::vector<Eigen::Vector3d>& line, double distance)
{
  for (std::size_t i = line.size() - 1; i > 0; --i)
  {
    const double length = (line[i] - line[i - 1]).norm();
    if (length >= distance && length > 0.0)
      return line[i] + distance / length * (line[i - 1] - line[i]);
    distance -= length;
  }
  return line.front();
}

}  // namespace

void SmoothPoint::jumpTo(const Eigen::Vector3d& point)
{
  point_ = point;
  velocity_.setZero();
}

const Eigen::Vector3d& SmoothPoint::follow(const Eigen::Vector3d& target, double rate, double seconds)
{
  // Solution of x'' = rate² (target − x) − 2 rate x' for a constant target.
  const double decay = std::exp(-rate * seconds);
  const Eigen::Vector3d distance = point_ - target;
  const Eigen::Vector3d slope = velocity_ + rate * distance;
  point_ = target + (distance + slope * seconds) * decay;
  velocity_ = (velocity_ - rate * seconds * slope) * decay;
  return point_;
}

void CameraGuide::setVessel(const VesselCentreline& message)
{
  centreline_.clear();
  radii_.clear();
  for (const VesselCentrelineBranch& branch : message.branches)
    for (std::size_t i = 0; i < std::min(branch.points.size(), branch.radii.size()); ++i)
    {
      const Eigen::Vector3d point = toEigen(branch.points[i]);
      if (!point.allFinite() || !std::isfinite(branch.radii[i]))
        continue;
      const Eigen::Vector3d radius = Eigen::Vector3d::Constant(std::max(branch.radii[i], 0.0));
      const bool is_first = centreline_.empty();
      low_ = is_first ? point - radius : low_.cwiseMin(point - radius).eval();
      high_ = is_first ? point + radius : high_.cwiseMax(point + radius).eval();
      centreline_.push_back(point);
      radii_.push_back(radius.x());
    }
}

void CameraGuide::setWire(const RodStateVisual& message, const motion::MotionMap& map)
{
  std::vector<Eigen::Vector3d> nodes;
  toEigen(message.nodes, nodes);
  map_ = map;
  if (!nodes.empty() &&
      std::all_of(nodes.begin(), nodes.end(), [](const Eigen::Vector3d& node) { return node.allFinite(); }))
    map_.pullBack(nodes, wire_);
}

void CameraGuide::beginAt(const CameraPose& pose)
{
  if (!pose.eye.allFinite() || !pose.focus.allFinite() || !pose.up.allFinite())
    return;
  const bool moves = mode_ == ViewMode::kAlongVessel;
  const Eigen::Vector3d focus = moves ? map_.pullBack(pose.focus) : pose.focus;
  const Eigen::Vector3d eye = moves ? map_.pullBack(pose.eye) : pose.eye;
  focus_.jumpTo(focus);
  offset_.jumpTo(eye - focus);
  up_.jumpTo(pose.up);
  has_begun_ = true;
}

double CameraGuide::fittingDistance(const ViewSetting& setting, double aspect, double field_of_view) const
{
  const Eigen::Vector3d forward = -directionOf(setting);
  const Eigen::Vector3d up = normalPart(Eigen::Vector3d::UnitZ(), forward);
  const Eigen::Vector3d right = forward.cross(up);
  const double slope = std::tan(0.5 * field_of_view) / kRim, upright = slope * (1.0 - setting.covered);
  double distance = 0.05;
  for (std::size_t i = 0; i < centreline_.size(); ++i)
  {
    const Eigen::Vector3d point = centreline_[i] - centre();
    const double depth = point.dot(forward);
    distance = std::max({distance, (std::abs(point.dot(up)) + radii_[i]) / upright - depth,
                         (std::abs(point.dot(right)) + radii_[i]) / (slope * aspect) - depth});
  }
  return centreline_.empty() ? (high_ - low_).norm() : distance;
}

CameraGuide::Target CameraGuide::alongTheVessel(double distance) const
{
  const Eigen::Vector3d behind = pointBeforeEnd(wire_, distance);
  // In the middle of the lumen the wire does not cover the picture.
  const auto nearest = std::min_element(centreline_.begin(), centreline_.end(),
                                        [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b)
                                        { return (a - behind).squaredNorm() < (b - behind).squaredNorm(); });
  const Eigen::Vector3d eye = nearest == centreline_.end() ? behind : *nearest;
  const Eigen::Vector3d& tip = wire_.back();
  return {tip,
          (eye - tip).norm() > 1e-4 ? Eigen::Vector3d(eye - tip) : Eigen::Vector3d(-1e-2 * Eigen::Vector3d::UnitY())};
}

CameraGuide::Target CameraGuide::targetOf(const ViewSetting& setting, double aspect, double field_of_view) const
{
  const bool is_distance_set = setting.distance > 0.0;
  if (mode_ == ViewMode::kOverview || wire_.empty())
  {
    const double distance = is_distance_set ? setting.distance : fittingDistance(setting, aspect, field_of_view);
    // The vessel stands in the middle of what is not covered.
    const Eigen::Vector3d up = normalPart(Eigen::Vector3d::UnitZ(), directionOf(setting));
    const double lower = setting.covered * distance * std::tan(0.5 * field_of_view);
    return {centre() - lower * up, distance * directionOf(setting)};
  }
  if (mode_ == ViewMode::kFollowTip)
    return {wire_.back(), (is_distance_set ? setting.distance : kTipDistance) * directionOf(setting)};
  return alongTheVessel(is_distance_set ? setting.distance : kDistanceBehind);
}

void CameraGuide::moveWithPatient(CameraPose& pose) const
{
  pose.eye = map_.position(pose.eye);
  pose.focus = map_.position(pose.focus);
  if ((pose.focus - pose.eye).norm() > 1e-9)
    pose.up = normalPart(pose.up, (pose.focus - pose.eye).normalized());
}

CameraPose CameraGuide::advance(const ViewSetting& setting, double seconds, double aspect, double field_of_view)
{
  const Target target = targetOf(setting, aspect, field_of_view);
  if (!has_begun_)
    beginAt({target.focus + target.offset, target.focus, Eigen::Vector3d::UnitZ()});
  const double time = std::isfinite(seconds) ? std::clamp(seconds, 0.0, 1.0) : 0.0;
  CameraPose pose;
  pose.focus = focus_.follow(target.focus, kRate, time);
  pose.eye = pose.focus + offset_.follow(target.offset, kRate, time);
  Eigen::Vector3d forward = pose.focus - pose.eye;
  forward = forward.norm() > 1e-9 ? forward.normalized() : Eigen::Vector3d(Eigen::Vector3d::UnitY());
  if (mode_ == ViewMode::kAlongVessel && !wire_.empty())
    up_.jumpTo(normalPart(up_.point(), forward));
  else
    up_.follow(Eigen::Vector3d::UnitZ(), kRate, time);
  pose.up = normalPart(up_.point(), forward);
  if (mode_ == ViewMode::kAlongVessel && !map_.resting())
    moveWithPatient(pose);
  return pose;
}

}  // namespace endovascular_sim::rviz_plugin
