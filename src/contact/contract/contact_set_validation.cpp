#include "contact/contract/contact_set_validation.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::contact
{
namespace
{

constexpr double kUnit = 1e-6;     // tolerance of a normal's squared length
constexpr double kSameGap = 1e-6;  // m: tolerance between the gap and the one computed from point and normal

bool isValidFeature(const Query& query, const Feature& feature)
{
  // Comparisons are written so that NaN fails them.
  const int edges = static_cast<int>(query.nodes.size()) - 1;
  if (feature.edge < query.first_node || feature.edge >= query.first_node + edges)
    return false;
  const double t = feature.parameter;
  if (!(t >= 0.0 && t <= 1.0 && feature.friction >= 0.0 && std::isfinite(feature.friction) && feature.stiffness > 0.0 &&
        feature.clearance_radius == feature.clearance_radius && std::abs(feature.normal.squaredNorm() - 1.0) < kUnit))
    return false;
  const auto node = static_cast<std::size_t>(feature.edge - query.first_node);
  const Eigen::Vector3d axis = (1.0 - t) * query.nodes[node] + t * query.nodes[node + 1];
  const double radius = (1.0 - t) * query.radius[node] + t * query.radius[node + 1];
  // Points that are not finite fail this comparison.
  return std::abs(feature.normal.dot(axis - feature.point) - radius - feature.gap) < kSameGap;
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
                     [&query](const Feature& feature) { return isValidFeature(query, feature); });
}

}  // namespace endovascular_sim::contact
