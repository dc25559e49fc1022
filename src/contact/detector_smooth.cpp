#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/detector.h"

namespace endovascular_sim::contact
{
namespace
{

constexpr double kSameDistance = 1e-12;  // m
constexpr double kEnd = 1e-3;            // share of a wire's edge at its ends that is left to the nodes' features
constexpr double kSameDirection = 0.5;   // cosine between the normals at both ends of an edge beside one sheet of wall
constexpr double kSamePlace = 0.02;      // of an edge: closer minima from different starts are one
constexpr int kMostTrials = 12;          // of the search along an edge
constexpr double kFoundSlope = 1e-6;     // sine of the angle between edge and wall at a minimum

double cutoffAt(const Query& query, std::size_t node)
{
  return query.radius[node] + query.margin[node];
}

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
  if (!list.hasTriangles())
    return;
  const SmoothFootSearch search(*model_->smooth());
  const NarrowPhase facets = model_->narrowPhase();
  const Eigen::Vector3d& begin = query.nodes[node];
  const Eigen::Vector3d along = query.nodes[node + 1] - begin;
  const double taper = query.radius[node + 1] - query.radius[node];
  const double length = along.norm();
  const auto slopeOf = [&](const SmoothFoot& foot) { return foot.normal.dot(along) - taper; };
  const std::size_t first = features.size();

  // Refines the minimum between parameters with a falling and a rising distance (Illinois method).
  const auto refine = [&](double low, SmoothFoot at_low, double high, const SmoothFoot& at_high)
  {
    double slope_low = slopeOf(at_low);
    double slope_high = slopeOf(at_high);
    SmoothFoot foot = at_low;
    double t = low;
    for (int trial = 0; trial < kMostTrials; ++trial)
    {
      t = (low * slope_high - high * slope_low) / (slope_high - slope_low);
      foot = search.walk(begin + t * along, foot);
      const double slope = slopeOf(foot);
      if (std::abs(slope) < kFoundSlope * length)
        break;
      if (slope < 0.0)
      {
        low = t;
        slope_low = slope;
        slope_high *= 0.5;
      }
      else
      {
        high = t;
        slope_high = slope;
        slope_low *= 0.5;
      }
    }
    const double cutoff = (1.0 - t) * cutoffAt(query, node) + t * cutoffAt(query, node + 1);
    if (t <= kEnd || t >= 1.0 - kEnd || std::abs(foot.height) > cutoff)
      return;
    // The back of another sheet of wall is no contact.
    if (foot.height >= 0.0 || model_->signedDistance(begin + t * along, foot.triangle) < 0.0)
      addSmoothMinimum(query, node, t, foot, first, features);
  };

  const SmoothFoot& foot0 = nearest_feet_[node];
  const SmoothFoot& foot1 = nearest_feet_[node + 1];
  const bool one_sheet = foot0.triangle >= 0 && foot1.triangle >= 0 && foot0.normal.dot(foot1.normal) > kSameDirection;
  if (one_sheet && slopeOf(foot0) < 0.0 && slopeOf(foot1) > 0.0)
    refine(0.0, foot0, 1.0, foot1);
  if (!list.hasEdges())
    return;
  const double reach = std::max(reachAt(query, node), reachAt(query, node + 1));
  const NarrowPhase::WireEdge wire_edge(begin, query.nodes[node + 1], taper);
  NarrowPhase::Minimum minimum;
  const auto test = [&](int wall_edge)
  {
    if (!facets.edgeEdgeFeature(wire_edge, wall_edge, reach, minimum))
      return;
    const double t = minimum.feature.parameter;
    const auto found = [t](const Feature& other) { return std::abs(other.parameter - t) < kSamePlace; };
    if (std::any_of(features.begin() + static_cast<std::ptrdiff_t>(first), features.end(), found))
      return;
    const SmoothFoot foot = search.walk(begin + t * along, minimum.feature.triangle);
    const double slope = slopeOf(foot);
    const double end = slope < 0.0 ? 1.0 : 0.0;
    const SmoothFoot at_end = search.walk(begin + end * along, foot);
    const double slope_at_end = slopeOf(at_end);
    if (slope < 0.0 && slope_at_end > 0.0)
      refine(t, foot, end, at_end);
    else if (slope >= 0.0 && slope_at_end < 0.0)
      refine(end, at_end, t, foot);
  };
  list.forEachEdge(wire_edge.begin, wire_edge.end, wire_edge.taper, reach, test);
}

}  // namespace endovascular_sim::contact
