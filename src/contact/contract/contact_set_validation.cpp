#include "contact/contract/contact_set_validation.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::contact
{
namespace
{

constexpr double kNormalTolerance = 1e-6;  // deviation of the squared length of a normal from 1
constexpr double kGapTolerance = 1e-6;     // m between the gap and the distance from the feature's plane

bool isConsistent(const Query& query, const Feature& feature)
{
  // Every comparison is false for NaN.
  const int edges = static_cast<int>(query.nodes.size()) - 1;
  if (feature.edge < query.first_node || feature.edge >= query.first_node + edges)
    return false;
  const double t = feature.parameter;
  if (!(t >= 0.0 && t <= 1.0 && feature.friction >= 0.0 && std::isfinite(feature.friction) && feature.stiffness > 0.0 &&
        feature.clearance_radius == feature.clearance_radius &&
        std::abs(feature.normal.squaredNorm() - 1.0) < kNormalTolerance))
    return false;
  const auto node = static_cast<std::size_t>(feature.edge - query.first_node);
  const Eigen::Vector3d axis = (1.0 - t) * query.nodes[node] + t * query.nodes[node + 1];
  const double radius = (1.0 - t) * query.radius[node] + t * query.radius[node + 1];
  // A point that is not finite fails this comparison.
  return std::abs(feature.normal.dot(axis - feature.point) - radius - feature.gap) < kGapTolerance;
}

}  // namespace

bool isValidAnswer(const Query& query, const ContactSet& set)
{
  const std::size_t edges = query.nodes.empty() ? 0 : query.nodes.size() - 1;
  return (query.vessel_version == 0 || set.vessel_version == query.vessel_version) && set.step == query.step &&
         set.substep == query.substep && set.pass == query.pass && set.first_edge == query.first_node &&
         set.free_distance.size() == edges &&
         std::all_of(set.free_distance.begin(), set.free_distance.end(),
                     [](double distance) { return distance >= 0.0; }) &&
         std::all_of(set.features.begin(), set.features.end(),
                     [&query](const Feature& feature) { return isConsistent(query, feature); });
}

}  // namespace endovascular_sim::contact
