#include "benchmark/reference/smooth_walls.h"

#include <cmath>

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kFar = 1.0;      // free distance beyond all features [m]
constexpr int kFacesPerNode = 2;  // stride of the feature numbers

}  // namespace

void SmoothWall::detect(const contact::Query& query, contact::ContactSet& set)
{
  set.stale = false;
  set.first_edge = query.first_node;
  set.free_distance.assign(query.nodes.empty() ? 0 : query.nodes.size() - 1, kFar);
  set.features.clear();
  contact::Feature feature;
  for (std::size_t i = 0; i < query.nodes.size() && query.nodes.size() > 1; ++i)
    for (int face = 0; measure(query.nodes[i], face, feature); ++face)
    {
      const bool last = i + 1 == query.nodes.size();
      const int node = query.first_node + static_cast<int>(i);
      feature.edge = node - (last ? 1 : 0);
      feature.parameter = last ? 1.0 : 0.0;
      feature.id = std::int64_t{kFacesPerNode} * node + face;
      set.features.push_back(feature);
    }
}

void SmoothWall::freeDistances(const contact::Query& query, double /*wanted*/, contact::ContactSet& set)
{
  detect(query, set);
}

bool FlatChannel::measure(const Eigen::Vector3d& axis, int face, contact::Feature& feature) const
{
  if (face > 1)
    return false;
  const bool ceiling = face == 1;
  feature.normal = Eigen::Vector3d(0.0, ceiling ? -1.0 : 1.0, 0.0);
  feature.gap = ceiling ? height_ - axis.y() : axis.y();
  feature.point = Eigen::Vector3d(axis.x(), ceiling ? height_ : 0.0, axis.z());
  return true;
}

bool Peg::measure(const Eigen::Vector3d& axis, int face, contact::Feature& feature) const
{
  if (face > 0)
    return false;
  Eigen::Vector3d offset = axis - centre_;
  offset.z() = 0.0;
  const double distance = offset.norm();
  feature.normal = offset / distance;
  feature.gap = distance - radius_;
  feature.point = axis - feature.gap * feature.normal;
  feature.friction = friction_;
  return true;
}

bool Trough::measure(const Eigen::Vector3d& axis, int face, contact::Feature& feature) const
{
  const Eigen::Vector3d across(0.0, axis.y(), axis.z());
  if (face > 0 || across.isZero(0.0))
    return false;
  feature.normal = -across.normalized();
  feature.gap = clearance_ - across.norm();
  feature.clearance_radius = clearance_;
  feature.point = axis - feature.gap * feature.normal;
  feature.friction = friction_;
  return true;
}

Eigen::Vector3d BentTube::closestPointOnAxis(const Eigen::Vector3d& point) const
{
  if (!std::isfinite(radius_))
    return {point.x(), 0.0, 0.0};
  const double along = point.x() - straight_;
  const double across = radius_ - point.y();
  const double turn = std::atan2(along, across);
  // Beyond the centre of the bend, the sign of the angle determines the nearer straight part.
  if (along < 0.0 && (turn < 0.0 && turn > 0.5 * angle_ - M_PI))
    return {point.x(), 0.0, 0.0};
  if (turn >= 0.0 && turn <= angle_)
    return {straight_ + radius_ * std::sin(turn), radius_ * (1.0 - std::cos(turn)), 0.0};
  const Eigen::Vector3d end(straight_ + radius_ * std::sin(angle_), radius_ * (1.0 - std::cos(angle_)), 0.0);
  const Eigen::Vector3d direction(std::cos(angle_), std::sin(angle_), 0.0);
  return end + direction.dot(point - end) * direction;
}

bool BentTube::measure(const Eigen::Vector3d& axis, int face, contact::Feature& feature) const
{
  const Eigen::Vector3d centre = closestPointOnAxis(axis);
  const double distance = (axis - centre).norm();
  if (face > 0 || distance < 1e-3 * clearance_)
    return false;
  feature.normal = (centre - axis) / distance;
  feature.gap = clearance_ - distance;
  feature.point = axis - feature.gap * feature.normal;
  feature.clearance_radius = clearance_;
  feature.friction = friction_;
  return true;
}

}  // namespace endovascular_sim::benchmark
