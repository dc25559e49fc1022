#include "contact/rollers.h"

#include <algorithm>
#include <cstdint>

namespace endovascular_sim::contact
{
namespace
{

constexpr std::int64_t kKindsOfFeatures = 3;  // of an id; a roller is a face

/** Vector from the axis of a roller to a point, perpendicular to the axis [m]. */
Eigen::Vector3d fromAxis(const Roller& roller, const Eigen::Vector3d& point)
{
  const Eigen::Vector3d from = point - roller.position;
  return from - roller.axis.dot(from) * roller.axis;
}

/** Parameter of the point of a line through two points that is nearest to the axis; 0 for a line along the axis. */
double nearestParameter(const Eigen::Vector3d& from_begin, const Eigen::Vector3d& from_end)
{
  const Eigen::Vector3d along = from_end - from_begin;
  const double squared = along.squaredNorm();
  return squared > 0.0 ? -along.dot(from_begin) / squared : 0.0;
}

double between(double a, double b, double parameter)
{
  return (1.0 - parameter) * a + parameter * b;
}

/** Sets the members that answers have in common. */
void beginAnswer(const Query& query, ContactSet& set)
{
  set.step = query.step;
  set.substep = query.substep;
  set.pass = query.pass;
  set.vessel_version = query.vessel_version;
  set.first_edge = query.first_node;
  set.features.clear();
  set.free_distance.resize(query.nodes.empty() ? 0 : query.nodes.size() - 1);
}

}  // namespace

double distanceFromAxis(const Roller& roller, const Eigen::Vector3d& point)
{
  return fromAxis(roller, point).norm();
}

double distanceFrom(const Roller& roller, const Eigen::Vector3d& point)
{
  return distanceFromAxis(roller, point) - roller.radius;
}

/** Adds the local minima of the distance to one roller. At a node, the distance is least where it decreases along the
 *  edge before it and increases along the edge behind it. */
void Rollers::addFeatures(const Query& query, std::size_t roller, std::vector<Feature>& features) const
{
  const Roller& at = rollers_[roller];
  bool approaches = true;  // the distance decreases at the end of the edge before
  for (std::size_t j = 0; j + 1 < query.nodes.size(); ++j)
  {
    const Eigen::Vector3d begin = fromAxis(at, query.nodes[j]);
    const Eigen::Vector3d end = fromAxis(at, query.nodes[j + 1]);
    const double nearest = nearestParameter(begin, end);
    const bool last = j + 2 == query.nodes.size();
    const bool is_minimum = nearest <= 0.0 ? approaches : nearest < 1.0 || last;
    approaches = nearest >= 1.0;
    if (!is_minimum)
      continue;
    Feature feature;
    feature.edge = query.first_node + static_cast<int>(j);
    feature.triangle = static_cast<int>(roller);
    feature.parameter = std::clamp(nearest, 0.0, 1.0);
    const Eigen::Vector3d from = begin + feature.parameter * (end - begin);
    const double distance = from.norm();
    if (distance <= 0.0)
      continue;  // on the axis: no direction leads out
    feature.normal = from / distance;
    const Eigen::Vector3d on_wire = query.nodes[j] + feature.parameter * (query.nodes[j + 1] - query.nodes[j]);
    feature.point = on_wire - (distance - at.radius) * feature.normal;
    feature.gap = distance - at.radius - between(query.radius[j], query.radius[j + 1], feature.parameter);
    feature.friction = at.friction;
    feature.id = kKindsOfFeatures * static_cast<std::int64_t>(roller);
    if (feature.gap < between(query.margin[j], query.margin[j + 1], feature.parameter))
      features.push_back(feature);
  }
}

void Rollers::detect(const Query& query, ContactSet& set)
{
  beginAnswer(query, set);
  for (std::size_t j = 0; j < set.free_distance.size(); ++j)
    set.free_distance[j] = std::min(query.margin[j], query.margin[j + 1]);
  for (std::size_t k = 0; k < rollers_.size(); ++k)
    addFeatures(query, k, set.features);
  std::stable_sort(set.features.begin(), set.features.end(),
                   [](const Feature& a, const Feature& b)
                   { return a.edge != b.edge ? a.edge < b.edge : a.parameter < b.parameter; });
}

void Rollers::freeDistances(const Query& query, double wanted, ContactSet& set)
{
  beginAnswer(query, set);
  for (std::size_t j = 0; j < set.free_distance.size(); ++j)
  {
    double nearest = wanted;
    for (const Roller& roller : rollers_)
    {
      const Eigen::Vector3d begin = fromAxis(roller, query.nodes[j]);
      const Eigen::Vector3d end = fromAxis(roller, query.nodes[j + 1]);
      const double parameter = std::clamp(nearestParameter(begin, end), 0.0, 1.0);
      const double surface = std::max(query.radius[j], query.radius[j + 1]) + roller.radius;
      nearest = std::min(nearest, (begin + parameter * (end - begin)).norm() - surface);
    }
    set.free_distance[j] = std::max(nearest, std::min(query.margin[j], query.margin[j + 1]));
  }
}

}  // namespace endovascular_sim::contact
