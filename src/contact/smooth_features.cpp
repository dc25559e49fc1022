#include "contact/smooth_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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

/** Adds the feature of a foot of a point of an edge. @param first index of the point's first feature */
void addMinimum(const Query& query, std::size_t node, double parameter, const SmoothFoot& foot, std::size_t first,
                std::vector<Feature>& features)
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

/** Interior minima of the distance between the wire's surface and the wall along one edge. They lie between ends where
 *  the wire approaches and leaves the same sheet of wall, and near reflex edges of the mesh. */
class EdgeFeatures
{
public:
  /** @param node at the edge's begin. The other arguments must outlive the object */
  EdgeFeatures(const WallModel& model, const SmoothFootSearch& search, const Query& query, std::size_t node,
               std::vector<Feature>& features)
    : model_(model),
      query_(query),
      node_(node),
      begin_(query.nodes[node]),
      along_(query.nodes[node + 1] - query.nodes[node]),
      walk_(search, begin_, along_, query.radius[node + 1] - query.radius[node]),
      first_(features.size()),
      features_(features)
  {
  }

  /** @param foot0, foot1 nearest feet of the edge's nodes; triangle −1: none */
  void addBetween(const SmoothFoot& foot0, const SmoothFoot& foot1)
  {
    if (foot0.triangle < 0 || foot1.triangle < 0 || foot0.normal.dot(foot1.normal) <= kSameDirection)
      return;
    const SmoothEdgeWalk::Place place0 = walk_.placeOf(0.0, foot0);
    const SmoothEdgeWalk::Place place1 = walk_.placeOf(1.0, foot1);
    if (place0.slope < 0.0 && place1.slope > 0.0)
      add(walk_.minimumBetween(place0, place1));
  }

  void addAtReflexEdges(const NeighbourList& list)
  {
    if (!list.hasEdges())
      return;
    const NarrowPhase facets = model_.narrowPhase();
    const double reach =
        std::max(cutoffAt(query_, node_) + model_.deviation(), cutoffAt(query_, node_ + 1) + model_.deviation());
    const NarrowPhase::WireEdge wire_edge(begin_, query_.nodes[node_ + 1],
                                          query_.radius[node_ + 1] - query_.radius[node_]);
    NarrowPhase::Minimum minimum;
    const auto test = [&](int wall_edge)
    {
      if (!model_.smooth()->mayBulge(wall_edge, along_) ||
          !facets.edgeEdgeFeature(wire_edge, wall_edge, reach, minimum) || !isWithinCutoff(minimum, wall_edge) ||
          isFound(minimum.feature))
        return;
      if (const auto place = walk_.minimumFrom(minimum.feature.parameter, minimum.feature.triangle))
        add(*place);
    };
    list.forEachEdge(wire_edge.begin, wire_edge.end, wire_edge.taper, reach, test);
  }

private:
  double cutoff(double parameter) const
  {
    return (1.0 - parameter) * cutoffAt(query_, node_) + parameter * cutoffAt(query_, node_ + 1);
  }

  /** @param minimum at a reflex edge of the facets, from which the smooth wall may deviate towards the wire */
  bool isWithinCutoff(const NarrowPhase::Minimum& minimum, int wall_edge) const
  {
    const SmoothWall& smooth = *model_.smooth();
    const std::array<int, 2>& sides = smooth.wall().edges[wall_edge].triangles;
    const double away = std::max(smooth.deviationOf(sides[0]), smooth.deviationOf(sides[1]));
    const double t = minimum.feature.parameter;
    return minimum.distance <= away + (1.0 - t) * cutoffAt(query_, node_) + t * cutoffAt(query_, node_ + 1);
  }

  /** Different sheets of wall may be met at the same place. */
  bool isFound(const Feature& feature) const
  {
    const auto same = [&feature](const Feature& other) {
      return std::abs(other.parameter - feature.parameter) < kSamePlace &&
             other.normal.dot(feature.normal) > kSameSheet;
    };
    return std::any_of(features_.begin() + static_cast<std::ptrdiff_t>(first_), features_.end(), same);
  }

  void add(const SmoothEdgeWalk::Place& place)
  {
    const double t = place.parameter;
    if (t <= kEnd || t >= 1.0 - kEnd || std::abs(place.foot.height) > cutoff(t))
      return;
    // The back of another sheet of wall is no contact.
    if (place.foot.height >= 0.0 || model_.signedDistance(begin_ + t * along_, place.foot.triangle) < 0.0)
      addMinimum(query_, node_, t, place.foot, first_, features_);
  }

  const WallModel& model_;
  const Query& query_;
  const std::size_t node_;
  const Eigen::Vector3d begin_, along_;
  const SmoothEdgeWalk walk_;
  const std::size_t first_;  ///< index of the edge's first feature
  std::vector<Feature>& features_;
};

}  // namespace

/** Feet of a node within the cutoff. Every triangle whose patch may contain one starts a walk, unless an earlier walk
 *  has ended inside that patch. */
void SmoothFeatures::findFeet(const WallModel& model, const NeighbourList& list, const Eigen::Vector3d& point,
                              double cutoff)
{
  feet_.clear();
  if (!list.hasTriangles())
    return;
  const SmoothWall& smooth = *model.smooth();
  const SmoothFootSearch search(smooth);
  const auto start = [&](int triangle)
  {
    if (!smooth.mayHaveFoot(triangle, model.bounds().triangle(triangle).heights(point), cutoff))
      return;
    const std::int64_t id = featureId(triangle, FeatureKind::kFace);
    if (std::any_of(feet_.begin(), feet_.end(), [id](const SmoothFoot& foot) { return foot.id == id; }))
      return;
    const SmoothFoot foot = search.walk(point, triangle);
    if (std::abs(foot.height) <= cutoff)
      feet_.push_back(foot);
  };
  list.forEachTriangle(point, cutoff + model.deviation(), start);
}

/** Features of a node from its feet: all in front of the wall with distinct normals, and the nearest if it is behind.
 */
void SmoothFeatures::addNodeFeatures(const Query& query, std::size_t node, std::vector<Feature>& features)
{
  SmoothFoot& nearest = nearest_[node];
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
      addMinimum(query, node, 0.0, foot, first, features);
}

void SmoothFeatures::find(const WallModel& model, const WireLists& lists, const Query& query,
                          std::vector<Feature>& features)
{
  const std::size_t n = query.nodes.size();
  if (nearest_.size() < n)
    nearest_.resize(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    findFeet(model, lists.of(query, i), query.nodes[i], cutoffAt(query, i));
    addNodeFeatures(query, i, features);
  }
  const SmoothFootSearch search(*model.smooth());
  for (std::size_t i = 0; i + 1 < n; ++i)
  {
    EdgeFeatures edge(model, search, query, i, features);
    edge.addBetween(nearest_[i], nearest_[i + 1]);
    edge.addAtReflexEdges(lists.of(query, i));
  }
}

double SmoothFeatures::distanceToListed(const WallModel& model, const NeighbourList& list, const Eigen::Vector3d& point,
                                        double cutoff) const
{
  const SmoothWall& smooth = *model.smooth();
  double nearest = std::numeric_limits<double>::infinity();
  const auto visit = [&](int t)
  { nearest = std::min(nearest, model.bvh().distanceTo(t, point) - smooth.deviationOf(t)); };
  list.forEachTriangle(point, cutoff + model.deviation(), visit);
  return nearest;
}

}  // namespace endovascular_sim::contact
