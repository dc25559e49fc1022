#include "contact/detector.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace endovascular_sim::contact
{
namespace
{

constexpr double kSameNormal = 0.9995;    // cosine between normals above which two features of a node are one
constexpr double kSameDistance = 1e-12;   // m
constexpr double kHorizon = 4.0;          // queries before its end in which a list is renewed
constexpr std::size_t kListsAtOnce = 16;  // for which memory is reserved together as the wire enters
constexpr std::size_t kUsualNodes = 512;  // of a wire

/** Index of the node at the other end of the edge behind a node; the tip has no such edge. */
std::size_t nextNode(const Query& query, std::size_t node)
{
  return std::min(node + 1, query.nodes.size() - 1);
}

}  // namespace

void appendDistinct(std::vector<Feature>& features, std::size_t first, const Feature& feature)
{
  for (std::size_t f = first; f < features.size(); ++f)
    if (features[f].id == feature.id || features[f].normal.dot(feature.normal) > kSameNormal)
    {
      if (feature.gap < features[f].gap)
        features[f] = feature;
      return;
    }
  features.push_back(feature);
}

Detector::Detector(std::shared_ptr<const WallModel> model, WallLaw law, std::uint64_t vessel_version)
  : model_(std::move(model)), law_(std::move(law)), vessel_version_(vessel_version), deviation_(model_->deviation())
{
  lists_.reserve(kUsualNodes);
}

Detector::Detector(const geometry::TriangleMesh& mesh, WallLaw law, std::uint64_t vessel_version)
  : Detector(WallModel::create(mesh, law.shape), law, vessel_version)
{
}

void Detector::moveVertices(const std::vector<int>& indices, const std::vector<Eigen::Vector3d>& positions,
                            std::uint64_t vessel_version)
{
  vessel_version_ = vessel_version;
  if (indices.empty())
    return;
  const NeighbourList::WallMovement& movement = WallModel::writable(model_).moveVertices(indices, positions);
  for (NeighbourList& list : lists_)
    list.followWall(movement);
}

/** Distance from the axis up to which facets of a node's features are needed: the cutoff and the distance between a
 *  smooth wall and its facets [m]. */
double Detector::reachAt(const Query& query, std::size_t node) const
{
  return cutoffAt(query, node) + deviation_;
}

/** Cutoff of a node's list: the larger one of its edge's ends [m]. */
double Detector::listCutoff(const Query& query, std::size_t node) const
{
  return std::max(reachAt(query, node), reachAt(query, nextNode(query, node)));
}

/** Lists of nodes that have just entered get their memory in groups, so that few steps allocate. */
void Detector::reserveLists(std::size_t nodes)
{
  if (nodes <= lists_.size())
    return;
  const std::size_t before = lists_.size();
  lists_.resize((nodes + kListsAtOnce - 1) / kListsAtOnce * kListsAtOnce);
  for (std::size_t k = before; k < lists_.size(); ++k)
    lists_[k].reserve();
}

/** Sets the common members of a contact set and updates the neighbour lists. */
void Detector::begin(const Query& query, ContactSet& set)
{
  set.step = query.step;
  set.substep = query.substep;
  set.pass = query.pass;
  set.vessel_version = vessel_version_;
  set.first_edge = query.first_node;
  set.features.clear();
  reserveLists(query.nodes.size());
  built_lists_ = 0;
  due_.clear();
  for (std::size_t i = 0; i < query.nodes.size(); ++i)
  {
    const Eigen::Vector3d& a = query.nodes[i];
    const Eigen::Vector3d& b = query.nodes[nextNode(query, i)];
    const double cutoff = listCutoff(query, i);
    NeighbourList& list = listOf(query, i);
    list.follow(a, b, cutoff);
    built_lists_ += !list.isValid();
    if (list.isValid() && list.queriesLeft() < kHorizon)
      due_.emplace_back(list.queriesLeft(), i);
    list.update(model_->bvh(), model_->bounds(), a, b, cutoff, scratch_);
  }
  renewDueLists(query);
}

/** Renews some of the lists that expire soon, the nearest ones to their end first. The lists of a wire that is pushed
 *  would otherwise expire together, and one query would pay for all of them. */
void Detector::renewDueLists(const Query& query)
{
  const auto share = static_cast<std::size_t>(std::ceil(static_cast<double>(due_.size()) / kHorizon));
  if (share <= built_lists_)
    return;
  const auto end = due_.begin() + static_cast<std::ptrdiff_t>(share - built_lists_);
  built_lists_ = share;
  std::partial_sort(due_.begin(), end, due_.end());
  for (auto due = due_.begin(); due != end; ++due)
  {
    const std::size_t i = due->second;
    listOf(query, i).renew(model_->bvh(), model_->bounds(), query.nodes[i], query.nodes[nextNode(query, i)],
                           listCutoff(query, i), scratch_);
  }
}

void Detector::detect(const Query& query, ContactSet& set)
{
  begin(query, set);
  const std::size_t n = query.nodes.size();
  set.free_distance.resize(n > 0 ? n - 1 : 0);
  for (std::size_t i = 0; i < set.free_distance.size(); ++i)
    set.free_distance[i] = std::min(query.margin[i], query.margin[i + 1]);
  const bool smooth = model_->smooth() != nullptr;
  if (smooth && nearest_feet_.size() < n)
    nearest_feet_.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    smooth ? detectSmoothNode(query, i, set.features) : detectNode(query, i, set.features);
  for (std::size_t i = 0; i + 1 < n; ++i)
    smooth ? detectSmoothEdge(query, i, set.features) : detectEdge(query, i, set.features);
  addLaw(query, set.features);
}

/** Features of a node: all local minima in front of the wall with distinct normals, and the nearest one behind the wall
 *  if the node is outside the lumen. */
void Detector::detectNode(const Query& query, std::size_t node, std::vector<Feature>& features)
{
  const NeighbourList& list = listOf(query, node);
  if (!list.hasTriangles())
    return;
  const NarrowPhase narrow_phase = model_->narrowPhase();
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
  if (std::isfinite(outside_distance) && outside_distance <= distanceToListed(list, point, cutoff) + kSameDistance &&
      model_->signedDistance(point, outside_feature.triangle) < 0.0)
    features.push_back(outside_feature);
}

/** Features between the nodes of an edge. */
void Detector::detectEdge(const Query& query, std::size_t node, std::vector<Feature>& features)
{
  const NeighbourList& list = listOf(query, node);
  if (!list.hasEdges())
    return;
  const NarrowPhase narrow_phase = model_->narrowPhase();
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
    if (minimum.outside && model_->signedDistance(wire_edge.pointAt(t), feature.triangle) > 0.0)
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

void Detector::addLaw(const Query& query, std::vector<Feature>& features) const
{
  const NarrowPhase narrow_phase = model_->narrowPhase();
  for (Feature& feature : features)
  {
    const auto edge = static_cast<std::size_t>(feature.edge - query.first_node);
    feature.stiffness = law_.stiffness;
    feature.friction = law_.frictionAt(feature.point);
    if (model_->smooth() == nullptr)
      feature.clearance_radius = narrow_phase.clearanceRadius(feature, query.nodes[edge + 1] - query.nodes[edge],
                                                              query.radius[edge + (feature.parameter < 1.0 ? 0 : 1)]);
  }
}

/** Distance to the listed triangles that may be a contact within the cutoff, a lower bound for a smooth wall; larger or
 *  infinite without one [m]. */
double Detector::distanceToListed(const NeighbourList& list, const Eigen::Vector3d& point, double cutoff) const
{
  double nearest = std::numeric_limits<double>::infinity();
  const SmoothWall* smooth = model_->smooth();
  const auto visit = [&](int t)
  {
    const double away = smooth != nullptr ? smooth->deviationOf(t) : 0.0;
    nearest = std::min(nearest, model_->bvh().distanceTo(t, point) - away);
  };
  list.forEachTriangle(point, cutoff + deviation_, visit);
  return nearest;
}

/** Distance from a node to the wall, at most @p farthest; within the cutoff the distance to its possible contacts,
 *  which are listed already [m]. */
double Detector::wallDistance(const Query& query, std::size_t node, double farthest)
{
  const Eigen::Vector3d& point = query.nodes[node];
  const double cutoff = cutoffAt(query, node);
  const double listed = distanceToListed(listOf(query, node), point, cutoff);
  if (listed <= cutoff)
    return listed;
  int& hint = nearest_[static_cast<std::size_t>(query.first_node) + node];
  const Bvh::Nearest found = model_->bvh().nearest(point, farthest + deviation_, hint);
  hint = found.triangle >= 0 ? found.triangle : hint;
  return found.distance - deviation_;
}

void Detector::freeDistances(const Query& query, double wanted, ContactSet& set)
{
  begin(query, set);
  const std::size_t whole = static_cast<std::size_t>(query.first_node) + query.nodes.size();
  if (nearest_.size() < whole)
    nearest_.resize(whole, -1);
  // The distance to the wall is 1-Lipschitz, so both ends bound it along the edge: (d0 + d1 − |e|)/2.
  set.free_distance.resize(query.nodes.empty() ? 0 : query.nodes.size() - 1);
  // Search radius: an edge whose ends are both at least this far from the wall has the wanted free distance. Where one
  // end is closer, the other's distance may be underestimated: a larger search costs more than a shorter motion.
  double reach = 0.0;
  for (std::size_t i = 1; i < query.nodes.size(); ++i)
    reach = std::max(
        reach, 0.5 * (query.nodes[i] - query.nodes[i - 1]).norm() + std::max(query.radius[i - 1], query.radius[i]));
  const double farthest = wanted + reach;
  double previous = 0.0;
  for (std::size_t i = 0; i < query.nodes.size(); ++i)
  {
    const double distance = wallDistance(query, i, farthest);
    if (i > 0)
    {
      const double length = (query.nodes[i] - query.nodes[i - 1]).norm();
      const double radius = std::max(query.radius[i - 1], query.radius[i]);
      const double margin = std::min(query.margin[i - 1], query.margin[i]);
      set.free_distance[i - 1] = std::max(margin, 0.5 * (previous + distance - length) - radius);
    }
    previous = distance;
  }
}

}  // namespace endovascular_sim::contact
