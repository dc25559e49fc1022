#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "contact/detector.h"
#include "contact/narrow_phase/smooth_edge_walk.h"

namespace endovascular_sim::contact
{
namespace
{

constexpr double kSameDistance = 1e-12;  // m
constexpr double kEnd = 1e-3;            // share of a wire's edge at its ends that is left to the nodes' features
constexpr double kSameDirection = 0.5;   // cosine between the normals at both ends of an edge beside one sheet of wall
constexpr double kSamePlace = 0.02;      // of an edge: closer minima of one sheet of wall are one
constexpr double kSameSheet = 0.9;       // cosine between the normals of one sheet there

}  // namespace

/** Feet of a node within the cutoff. Every triangle whose patch may contain one starts a walk, unless an earlier walk
 *  has ended inside that patch. */
void Detector::findFeet(const Query& query, std::size_t node)
{
  feet_.clear();
  const NeighbourList& list = listOf(query, node);
  if (!list.hasTriangles())
    return;
  const SmoothWall& smooth = *model_->smooth();
  const SmoothFootSearch search(smooth);
  const Eigen::Vector3d& point = query.nodes[node];
  const double cutoff = cutoffAt(query, node);
  const auto start = [&](int triangle)
  {
    if (!smooth.mayHaveFoot(triangle, model_->bounds().triangle(triangle).heights(point), cutoff))
      return;
    const std::int64_t id = featureId(triangle, FeatureKind::kFace);
    if (std::any_of(feet_.begin(), feet_.end(), [id](const SmoothFoot& foot) { return foot.id == id; }))
      return;
    const SmoothFoot foot = search.walk(point, triangle);
    if (std::abs(foot.height) <= cutoff)
      feet_.push_back(foot);
  };
  list.forEachTriangle(point, reachAt(query, node), start);
}

/** Features of a node: all feet in front of the wall with distinct normals, and the nearest foot if it is behind. */
void Detector::detectSmoothNode(const Query& query, std::size_t node, std::vector<Feature>& features)
{
  findFeet(query, node);
  SmoothFoot& nearest = nearest_feet_[node];
  nearest.triangle = -1;
  double distance = std::numeric_limits<double>::infinity();
  for (const SmoothFoot& foot : feet_)
    if (std::abs(foot.height) < distance)
    {
      distance = std::abs(foot.height);
      nearest = foot;
    }
  const std::size_t first = features.size();
  for (const SmoothFoot& foot : feet_)
    if (foot.height >= 0.0 || -foot.height <= distance + kSameDistance)
      addSmoothMinimum(query, node, 0.0, foot, first, features);
}

/** Adds the feature of a foot of a point of an edge. @param first index of the point's first feature */
void Detector::addSmoothMinimum(const Query& query, std::size_t node, double parameter, const SmoothFoot& foot,
                                std::size_t first, std::vector<Feature>& features)
{
  const bool last = node + 1 == query.nodes.size();
  const std::size_t begin = last ? node - 1 : node;
  const double t = last ? 1.0 : parameter;
  const Eigen::Vector3d along = query.nodes[begin + 1] - query.nodes[begin];
  const Eigen::Vector3d point = last || t <= 0.0 ? query.nodes[node] : Eigen::Vector3d(query.nodes[begin] + t * along);
  const double radius = (1.0 - t) * query.radius[begin] + t * query.radius[begin + 1];
  Feature feature = minimumOf(foot, point).feature;
  feature.edge = query.first_node + static_cast<int>(begin);
  feature.parameter = t;
  feature.gap -= radius;
  feature.clearance_radius = clearanceRadiusOf(foot, along, radius);
  appendDistinct(features, first, feature);
}

/** Features between the nodes of an edge: interior minima of the distance between the wire's surface and the wall. They
 *  lie between ends where the wire approaches and leaves the same sheet of wall, and near reflex edges of the mesh. */
void Detector::detectSmoothEdge(const Query& query, std::size_t node, std::vector<Feature>& features)
{
  const NeighbourList& list = listOf(query, node);
  const SmoothWall& smooth = *model_->smooth();
  const SmoothFootSearch search(smooth);
  const Eigen::Vector3d& begin = query.nodes[node];
  const Eigen::Vector3d& end = query.nodes[node + 1];
  const double taper = query.radius[node + 1] - query.radius[node];
  const SmoothEdgeWalk edge(search, begin, end - begin, taper);
  const std::size_t first = features.size();
  const auto add = [&](const SmoothEdgeWalk::Place& place)
  {
    const double t = place.parameter;
    const double cutoff = (1.0 - t) * cutoffAt(query, node) + t * cutoffAt(query, node + 1);
    if (t <= kEnd || t >= 1.0 - kEnd || std::abs(place.foot.height) > cutoff)
      return;
    // The back of another sheet of wall is no contact.
    if (place.foot.height >= 0.0 || model_->signedDistance(begin + t * (end - begin), place.foot.triangle) < 0.0)
      addSmoothMinimum(query, node, t, place.foot, first, features);
  };

  const SmoothFoot& foot0 = nearest_feet_[node];
  const SmoothFoot& foot1 = nearest_feet_[node + 1];
  if (foot0.triangle >= 0 && foot1.triangle >= 0 && foot0.normal.dot(foot1.normal) > kSameDirection)
  {
    const SmoothEdgeWalk::Place place0 = edge.placeOf(0.0, foot0);
    const SmoothEdgeWalk::Place place1 = edge.placeOf(1.0, foot1);
    if (place0.slope < 0.0 && place1.slope > 0.0)
      add(edge.minimumBetween(place0, place1));
  }
  if (!list.hasEdges())
    return;
  const NarrowPhase facets = model_->narrowPhase();
  const double reach = std::max(reachAt(query, node), reachAt(query, node + 1));
  const NarrowPhase::WireEdge wire_edge(begin, end, taper);
  NarrowPhase::Minimum minimum;
  const auto test = [&](int wall_edge)
  {
    if (!smooth.mayBulge(wall_edge, end - begin) || !facets.edgeEdgeFeature(wire_edge, wall_edge, reach, minimum))
      return;
    const double t = minimum.feature.parameter;
    const std::array<int, 2>& sides = smooth.wall().edges[wall_edge].triangles;
    const double away = std::max(smooth.deviationOf(sides[0]), smooth.deviationOf(sides[1]));
    if (minimum.distance > away + (1.0 - t) * cutoffAt(query, node) + t * cutoffAt(query, node + 1))
      return;
    // Different sheets of wall may be met at the same place.
    const Eigen::Vector3d& normal = minimum.feature.normal;
    const auto found = [t, &normal](const Feature& other)
    { return std::abs(other.parameter - t) < kSamePlace && other.normal.dot(normal) > kSameSheet; };
    if (std::any_of(features.begin() + static_cast<std::ptrdiff_t>(first), features.end(), found))
      return;
    if (const auto place = edge.minimumFrom(t, minimum.feature.triangle))
      add(*place);
  };
  list.forEachEdge(begin, end, taper, reach, test);
}

}  // namespace endovascular_sim::contact
