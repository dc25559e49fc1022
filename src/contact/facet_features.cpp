#include "contact/facet_features.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace endovascular_sim::contact
{
namespace
{

constexpr double kSameDistance = 1e-12;  // m

/** Distance to the nearest of the listed triangles within the cutoff; infinite without one [m]. */
double distanceToTriangles(const WallModel& model, const NeighbourList& list, const Eigen::Vector3d& point,
                           double cutoff)
{
  double nearest = std::numeric_limits<double>::infinity();
  list.forEachTriangle(point, cutoff, [&](int t) { nearest = std::min(nearest, model.bvh().distanceTo(t, point)); });
  return nearest;
}

/** Features of a node: all local minima in front of the wall with distinct normals, and the nearest one behind the wall
 *  if the node is outside the lumen. */
void addNodeFeatures(const WallModel& model, const NeighbourList& list, const Query& query, std::size_t node,
                     std::vector<Feature>& features)
{
  if (!list.hasTriangles())
    return;
  const NarrowPhase narrow_phase = model.narrowPhase();
  const Eigen::Vector3d& point = query.nodes[node];
  const double cutoff = cutoffAt(query, node);
  const std::size_t first = features.size();
  const bool last = node + 1 == query.nodes.size();
  Feature outside_feature;
  double outside_distance = std::numeric_limits<double>::infinity();
  NarrowPhase::Minimum minimum;
  const auto test = [&](int triangle)
  {
    if (!narrow_phase.faceFeature(point, triangle, cutoff, minimum))
      return;
    Feature& feature = minimum.feature;
    feature.edge = query.first_node + static_cast<int>(node) - (last ? 1 : 0);
    feature.parameter = last ? 1.0 : 0.0;
    feature.gap -= query.radius[node];
    if (!minimum.outside)
      appendDistinct(features, first, feature);
    else if (minimum.distance < outside_distance)
    {
      outside_distance = minimum.distance;
      outside_feature = feature;
    }
  };
  list.forEachTriangle(point, cutoff, test);
  if (std::isfinite(outside_distance) &&
      outside_distance <= distanceToTriangles(model, list, point, cutoff) + kSameDistance &&
      model.signedDistance(point, outside_feature.triangle) < 0.0)
    features.push_back(outside_feature);
}

/** Features between the nodes of an edge. @param node at the edge's begin */
void addEdgeFeatures(const WallModel& model, const NeighbourList& list, const Query& query, std::size_t node,
                     std::vector<Feature>& features)
{
  if (!list.hasEdges())
    return;
  const NarrowPhase narrow_phase = model.narrowPhase();
  const double cutoff_begin = cutoffAt(query, node);
  const double cutoff_end = cutoffAt(query, node + 1);
  const double cutoff = std::max(cutoff_begin, cutoff_end);
  const NarrowPhase::WireEdge wire_edge(query.nodes[node], query.nodes[node + 1],
                                        query.radius[node + 1] - query.radius[node]);
  const auto begin = static_cast<std::ptrdiff_t>(features.size());
  NarrowPhase::Minimum minimum;
  const auto test = [&](int wall_edge)
  {
    if (!narrow_phase.edgeEdgeFeature(wire_edge, wall_edge, cutoff, minimum))
      return;
    Feature& feature = minimum.feature;
    const double t = feature.parameter;
    if (minimum.outside && model.signedDistance(wire_edge.pointAt(t), feature.triangle) > 0.0)
      return;
    if (feature.gap > (1.0 - t) * cutoff_begin + t * cutoff_end)
      return;
    feature.gap -= (1.0 - t) * query.radius[node] + t * query.radius[node + 1];
    feature.edge = query.first_node + static_cast<int>(node);
    const auto same = [&feature](const Feature& other) { return other.id == feature.id; };
    // Several mesh edges share a vertex; an edge itself is listed once.
    if (kindOf(feature) == FeatureKind::kEdge || std::none_of(features.begin() + begin, features.end(), same))
      features.push_back(feature);
  };
  list.forEachEdge(wire_edge.begin, wire_edge.end, wire_edge.taper, cutoff, test);
}

}  // namespace

void FacetFeatures::find(const WallModel& model, const WireLists& lists, const Query& query,
                         std::vector<Feature>& features)
{
  const std::size_t n = query.nodes.size();
  for (std::size_t i = 0; i < n; ++i)
    addNodeFeatures(model, lists.of(query, i), query, i, features);
  for (std::size_t i = 0; i + 1 < n; ++i)
    addEdgeFeatures(model, lists.of(query, i), query, i, features);
  const NarrowPhase narrow_phase = model.narrowPhase();
  for (Feature& feature : features)
  {
    const auto edge = static_cast<std::size_t>(feature.edge - query.first_node);
    feature.clearance_radius = narrow_phase.clearanceRadius(feature, query.nodes[edge + 1] - query.nodes[edge],
                                                            query.radius[edge + (feature.parameter < 1.0 ? 0 : 1)]);
  }
}

double FacetFeatures::distanceToListed(const WallModel& model, const NeighbourList& list, const Eigen::Vector3d& point,
                                       double cutoff) const
{
  return distanceToTriangles(model, list, point, cutoff);
}

}  // namespace endovascular_sim::contact
