#include "contact/detector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "geometry/closest_point_on_triangle.h"
#include "geometry/closest_points_on_segments.h"

namespace endovascular_sim::contact
{
namespace
{

constexpr double kReflexAngle = 1e-4;        // rad: edges that bulge less than this meet the wire's nodes only
constexpr double kOutsideCrossing = 0.4e-3;  // m by which a wire's edge may lie beyond a ridge
constexpr double kSameNormal = 0.9995;       // cosine above which two features of a node count as one
constexpr double kConeTolerance = 1e-12;     // m
constexpr double kConeSlack = 1e-3;          // of the distance: crossings at the border of the normal cone count
// The same in ridge's angles. A wire that lies along a facet touches it at the facet's border too: if that contact came
// and went with the wire's direction, wire and solver would rock.
constexpr double kConeSlackOfAngle = 0.1;
constexpr double kWidestWire = 0.6e-3;       // m from a wire's axis up to which that holds
constexpr double kOnRidge = 1e-12;           // m
constexpr double kSharp = 1.2;               // rad between triangles or of a vertex's cone that is not bounded
constexpr double kLeastClearance = 0.05e-3;  // m
constexpr std::size_t kUsualNodes = 512;     // of a wire; longer ones get their lists later
constexpr std::size_t kUsualList = 16;       // entries
constexpr double kEnd = 1e-3;                // of a wire's edge: closer to a node the node's own features stand

enum FeatureKind
{
  kFace = 0,
  kEdge = 1,
  kVertex = 2,
};

/** How far beside what it stands on a cone reaches, as a share of the height. @param angle to its axis [rad] */
double slopeOf(double angle)
{
  return angle > kSharp ? std::numeric_limits<double>::infinity() : std::tan(angle);
}

std::int64_t featureId(int index, FeatureKind kind)
{
  return std::int64_t{3} * index + kind;
}

}  // namespace

double WallLaw::frictionAt(const Eigen::Vector3d& place) const
{
  for (auto region = regions.rbegin(); region != regions.rend(); ++region)
    if ((place - region->centre).squaredNorm() <= region->radius * region->radius)
      return region->friction;
  return friction;
}

Detector::Detector(const geometry::TriangleMesh& mesh, WallLaw law, std::uint64_t vessel_version)
  : wall_(mesh), bvh_(wall_), law_(std::move(law)), vessel_version_(vessel_version)
{
  prisms_.resize(wall_.triangles.size());
  for (std::size_t t = 0; t < prisms_.size(); ++t)
    makePrism(static_cast<int>(t));
  edge_balls_.reserve(wall_.edges.size());
  for (const WallEdge& edge : wall_.edges)
    edge_balls_.push_back(ballOf(edge));
  std::vector<Bvh::Cone> cones;
  cones.reserve(prisms_.size());
  for (std::size_t t = 0; t < prisms_.size(); ++t)
    cones.push_back(coneOf(static_cast<int>(t)));
  bvh_.setCones(cones);
  // The first call shall not wait for memory.
  near_.resize(kUsualNodes);
  left_.resize(kUsualNodes);
  trails_.resize(kUsualNodes + 1);
  const auto prepare = [](NeighbourList& near)
  {
    const auto reserve = [](auto& list, std::size_t count)
    {
      list.resize(count);
      list.clear();
    };
    reserve(near.triangles, kUsualList);
    reserve(near.edges, kUsualList);
    reserve(near.prisms, kUsualList / kQuad);
    reserve(near.ridges, kUsualList / kQuad);
  };
  std::for_each(near_.begin(), near_.end(), prepare);
  std::for_each(left_.begin(), left_.end(), prepare);
}

EdgeBounds Detector::ballOf(const WallEdge& edge) const
{
  const Eigen::Vector3d& begin = wall_.vertices[edge.vertices[0]];
  const Eigen::Vector3d& end = wall_.vertices[edge.vertices[1]];
  const Eigen::Vector3d half = 0.5 * (end - begin);
  return {0.5 * (begin + end), edge.normal, half, half.norm(), leanOf(edge), edge.reflex_angle > kReflexAngle};
}

/** A local minimum's offset lies between the normals of the edge's triangles, or at an end in the vertex's cone. */
double Detector::leanOf(const WallEdge& edge) const
{
  const double slack = std::max(kConeSlack, kConeSlackOfAngle * std::abs(edge.reflex_angle));
  double widest = 0.5 * edge.reflex_angle + 1.1 * slack;  // rad
  for (int vertex : edge.vertices)
    widest = std::max(widest, wall_.vertex_cone[vertex] + angleBetween(edge.normal, wall_.vertex_normals[vertex]));
  return slopeOf(std::abs(edge.reflex_angle) > kSharp ? M_PI : widest);
}

void Detector::makePrism(int triangle)
{
  TriangleSlab& prism = prisms_[triangle];
  setSlopes(triangle, prism);
  const auto set = [&prism](int lane, const Eigen::Vector3d& normal, double offset)
  {
    for (int axis = 0; axis < 3; ++axis)
      prism.planes[axis][lane] = normal[axis];
    prism.planes[3][lane] = -offset;
  };
  set(0, wall_.normals[triangle], wall_.plane_offsets[triangle]);
  for (int k = 0; k < 3; ++k)
  {
    const int vertex = wall_.triangles[triangle][k];
    const int e = wall_.triangle_edges[triangle][k];
    const WallEdge& edge = wall_.edges[e];
    const int side = edge.triangles[0] == triangle ? 0 : 1;
    set(k + 1, edge.into_triangle[side], edge.into_triangle[side].dot(wall_.vertices[vertex]));
    prism.own_edges[k] = side == 0 && edge.reflex_angle > kReflexAngle ? e : -1;
  }
}

/** Where a reflex edge is closest, the point lies between both triangles' normals, where a reflex vertex is, in its
 *  cone. The foot lies no farther beyond a line along an edge than beyond the triangle: corners of any angle will do.
 *  Where the lumen is convex, what is closest to a point behind the wall lies behind the triangle too, unless the wall
 *  folds there by more than a right angle. What belongs to another triangle is seen there. */
void Detector::setSlopes(int triangle, TriangleSlab& prism) const
{
  double widest_edge = 0.0;    // rad
  double widest_corner = 0.0;  // rad
  for (int k = 0; k < 3; ++k)
  {
    const WallEdge& edge = wall_.edges[wall_.triangle_edges[triangle][k]];
    if (edge.triangles[0] == triangle)
      widest_edge = std::max(widest_edge, edge.reflex_angle > -kSharp ? edge.reflex_angle : M_PI);
    const int vertex = wall_.triangles[triangle][k];
    if (wall_.ownerOf(vertex) != triangle)
      continue;
    if (wall_.vertex_reflex[vertex] != 0)
      widest_corner = std::max(widest_corner, angleBetween(wall_.normals[triangle], wall_.vertex_normals[vertex]) +
                                                  wall_.vertex_cone[vertex]);
    else if (foldsAt(vertex, triangle))
      widest_corner = M_PI;
  }
  prism.edge_slope = slopeOf(widest_edge);
  prism.corner_slope = slopeOf(widest_corner);
}

/** Whether a triangle at the vertex is turned against another one there by about a right angle, or more. */
bool Detector::foldsAt(int vertex, int triangle) const
{
  const double least = std::cos(kSharp);
  const auto turned = [this, triangle, least](int other)
  { return wall_.normals[other].dot(wall_.normals[triangle]) < least; };
  const std::vector<int>& edges = wall_.vertex_edges[vertex];
  return std::any_of(edges.begin(), edges.end(),
                     [&](int e) { return turned(wall_.edges[e].triangles[0]) || turned(wall_.edges[e].triangles[1]); });
}

Bvh::Cone Detector::coneOf(int triangle) const
{
  const TriangleSlab& prism = prisms_[triangle];
  Bvh::Cone cone{prism.bulge(), -1.0};
  for (int e : prism.own_edges)
    if (e >= 0)
    {
      const double tilt = angleBetween(wall_.normals[triangle], wall_.edges[e].normal);
      const double widest = tilt + std::atan(edge_balls_[e].lean);
      cone.ridge = std::max(cone.ridge, slopeOf(widest));
    }
  return cone;
}

double Detector::signedDistance(const Eigen::Vector3d& point, int near, int* nearest) const
{
  const Bvh::Nearest found = bvh_.nearest(point, std::numeric_limits<double>::infinity(), near);
  if (nearest != nullptr)
    *nearest = found.triangle;
  const Eigen::Vector3i& corners = wall_.triangles[found.triangle];
  const geometry::TrianglePoint closest = geometry::closestPointOnTriangle(
      point, wall_.vertices[corners[0]], wall_.vertices[corners[1]], wall_.vertices[corners[2]]);
  const Eigen::Vector3d& normal = closest.vertex >= 0 ? wall_.vertex_normals[corners[closest.vertex]]
                                  : closest.edge >= 0
                                      ? wall_.edges[wall_.triangle_edges[found.triangle][closest.edge]].normal
                                      : wall_.normals[found.triangle];
  return (point - closest.point).dot(normal) >= 0.0 ? found.distance : -found.distance;
}

/** Sets what every answer holds, and follows the wire. */
void Detector::begin(const Query& query, ContactSet& set)
{
  set.step = query.step;
  set.substep = query.substep;
  set.pass = query.pass;
  set.vessel_version = vessel_version_;
  set.first_edge = query.first_node;
  set.features.clear();
  const std::size_t n = query.nodes.size();
  if (near_.size() < n)
  {
    near_.resize(n);
    trails_.resize(n + 1);
  }
  followWire(query);
}

void Detector::detect(const Query& query, ContactSet& set)
{
  begin(query, set);
  const std::size_t n = query.nodes.size();
  set.free_distance.resize(n > 0 ? n - 1 : 0);
  for (std::size_t i = 0; i < set.free_distance.size(); ++i)
    set.free_distance[i] = std::min(query.margin[i], query.margin[i + 1]);
  if (helper_ != nullptr && cutIntoParts(query))
  {
    detectParts(query, set.features);
    return;
  }
  renewLists(query);
  for (std::size_t i = 0; i < n; ++i)
    detectNode(query, i, set.features);
  for (std::size_t i = 0; i + 1 < n; ++i)
    detectEdge(query, i, set.features);
  addLaw(query, set.features);
}

void Detector::addLaw(const Query& query, std::vector<Feature>& features) const
{
  for (Feature& feature : features)
  {
    feature.friction = law_.frictionAt(feature.point);
    feature.clearance_radius = clearanceRadius(query, feature);
  }
}

/** The wall's radius of curvature across the wire, less the wire's own; infinite where it is not concave there. */
double Detector::clearanceRadius(const Query& query, const Feature& feature) const
{
  const double infinity = std::numeric_limits<double>::infinity();
  if (feature.id % 3 != kFace)
    return infinity;
  const auto edge = static_cast<std::size_t>(feature.edge - query.first_node);
  const Eigen::Vector3d across = feature.normal.cross(query.nodes[edge + 1] - query.nodes[edge]);
  const double curvature = across.dot(wall_.curvature[feature.triangle] * across) / across.squaredNorm();
  // A wire as wide as the lumen still has room to move in; a wire that points at the wall has no direction across.
  const double radius = query.radius[edge + (feature.parameter < 1.0 ? 0 : 1)];
  return curvature > 0.0 ? std::max(kLeastClearance, 1.0 / curvature - radius) : infinity;
}

void Detector::appendDistinct(std::vector<Feature>& features, std::size_t first, const Feature& feature) const
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

void Detector::detectNode(const Query& query, std::size_t index, std::vector<Feature>& features) const
{
  const NeighbourList& near = neighbourhood(query, index);
  if (near.triangles.empty())
    return;
  const Eigen::Vector3d& point = query.nodes[index];
  const double radius = query.radius[index];
  const double limit = limitAt(query, index);
  const std::size_t first = features.size();
  const bool last = index + 1 == query.nodes.size();
  Feature outside_feature;
  double outside_distance = std::numeric_limits<double>::infinity();
  Feature feature;
  const auto look = [&](int triangle)
  {
    double distance = 0.0;
    bool outside = false;
    if (!faceFeature(point, triangle, limit, feature, distance, outside))
      return;
    feature.edge = query.first_node + static_cast<int>(index) - (last ? 1 : 0);
    feature.parameter = last ? 1.0 : 0.0;
    feature.gap -= radius;
    if (!outside)
      appendDistinct(features, first, feature);
    else if (distance < outside_distance)
    {
      outside_distance = distance;
      outside_feature = feature;
    }
  };
  forEachInSight(near.prisms, TrianglePacket::Place(point, near.begin, limit, near.moved), look);
  if (std::isfinite(outside_distance) && outside_distance <= nearestListed(near, point, limit) + 1e-12 &&
      signedDistance(point, outside_feature.triangle) < 0.0)
    features.push_back(outside_feature);
}

/** @param limit distance up to which features are wanted [m]
 *  @param distance to the triangle, where its closest point is one
 *  @return whether the closest point is a local minimum of the distance to the wall; then @p feature holds it, its gap
 *  measured from the point itself */
bool Detector::faceFeature(const Eigen::Vector3d& point, int triangle, double limit, Feature& feature, double& distance,
                           bool& outside) const
{
  const TriangleSlab& prism = prisms_[triangle];
  const Eigen::Array4d above = prism.heights(point);
  const double height = above[0];
  if (height * height > limit * limit)
    return false;
  const Eigen::Vector3d normal = prism.normal();
  feature.triangle = triangle;
  feature.stiffness = law_.stiffness;
  if (TriangleSlab::outsideOf(above) < -kOffTriangle)
  {
    distance = std::abs(height);
    outside = height < 0.0;
    feature.point = point - height * normal;
    feature.normal = normal;
    feature.gap = height;
    feature.id = featureId(triangle, kFace);
    return true;
  }
  const Eigen::Vector3i& corners = wall_.triangles[triangle];
  geometry::TrianglePoint closest = geometry::closestPointOnTriangle(
      point, wall_.vertices[corners[0]], wall_.vertices[corners[1]], wall_.vertices[corners[2]]);
  if (closest.edge >= 0)
    closest.point = placeOnEdge(point, wall_.triangle_edges[triangle][closest.edge]);
  const Eigen::Vector3d offset = point - closest.point;
  const double squared = offset.squaredNorm();
  if (squared > limit * limit)
    return false;
  distance = std::sqrt(squared);
  feature.point = closest.point;
  // A foot point on the border of a flat neighbourhood is a face's too: neither neighbour would claim it otherwise.
  const bool foot_inside = closest.edge < 0 && closest.vertex < 0;
  if (foot_inside || (height >= 0.0 && (offset - height * normal).squaredNorm() < kConeTolerance * kConeTolerance))
  {
    outside = height < 0.0;
    feature.normal = normal;
    feature.gap = height;
    feature.id = featureId(triangle, kFace);
    return true;
  }
  Eigen::Vector3d pseudo_normal;
  if (closest.edge >= 0)
  {
    const int e = wall_.triangle_edges[triangle][closest.edge];
    const WallEdge& edge = wall_.edges[e];
    pseudo_normal = edge.normal;
    outside = offset.dot(pseudo_normal) < 0.0;
    if ((!outside && edge.reflex_angle <= 0.0) || offset.dot(edge.into_triangle[0]) > kConeTolerance ||
        offset.dot(edge.into_triangle[1]) > kConeTolerance)
      return false;
    feature.triangle = edge.triangles[0];
    feature.id = featureId(e, kEdge);
  }
  else
  {
    const int vertex = corners[closest.vertex];
    pseudo_normal = wall_.vertex_normals[vertex];
    outside = offset.dot(pseudo_normal) < 0.0;
    if ((!outside && !wall_.vertex_reflex[vertex]) || !vertexIsMinimum(vertex, offset))
      return false;
    feature.triangle = wall_.ownerOf(vertex);
    feature.id = featureId(vertex, kVertex);
  }
  const double sign = outside ? -1.0 : 1.0;
  feature.normal = distance > kOnRidge ? Eigen::Vector3d((sign / distance) * offset) : pseudo_normal;
  feature.gap = sign * distance;
  return true;
}

/** Closest point of a mesh edge: the same from both of its triangles. */
Eigen::Vector3d Detector::placeOnEdge(const Eigen::Vector3d& point, int wall_edge) const
{
  const WallEdge& edge = wall_.edges[wall_edge];
  const Eigen::Vector3d& begin = wall_.vertices[edge.vertices[0]];
  const Eigen::Vector3d along = wall_.vertices[edge.vertices[1]] - begin;
  return begin + geometry::clampedShare((point - begin).dot(along) / along.squaredNorm()) * along;
}

bool Detector::vertexIsMinimum(int vertex, const Eigen::Vector3d& offset) const
{
  for (int e : wall_.vertex_edges[vertex])
  {
    const WallEdge& edge = wall_.edges[e];
    const Eigen::Vector3d along = wall_.vertices[edge.otherEnd(vertex)] - wall_.vertices[vertex];
    const double beyond = offset.dot(along);
    if (beyond > 0.0 && beyond > kConeTolerance * along.norm())
      return false;
  }
  return true;
}

Detector::AxisSegment::AxisSegment(const Eigen::Vector3d& from, const Eigen::Vector3d& to)
  : begin(from), end(to), along(to - from)
{
  const double squared = along.squaredNorm();
  if (squared <= 0.0)
    return;
  inverse_square = 1.0 / squared;
}

/** Cheap rejection: whether any point of a reflex mesh edge lies within a limit of a segment. A segment whose ends are
 *  both higher than the limit above the mesh edge is higher all along. */
bool Detector::mayContact(const AxisSegment& segment, int wall_edge, double limit) const
{
  const EdgeBounds& ball = edge_balls_[wall_edge];
  if (!ball.reflex)
    return false;
  const Eigen::Vector3d from_begin = segment.begin - ball.middle;
  const Eigen::Vector3d from_end = segment.end - ball.middle;
  if (from_begin.dot(ball.normal) > limit && from_end.dot(ball.normal) > limit)
    return false;
  const double t = geometry::clampedShare(-from_begin.dot(segment.along) * segment.inverse_square);
  const double far = limit + ball.half_length;
  return (from_begin + t * segment.along).squaredNorm() <= far * far;
}

void Detector::detectEdge(const Query& query, std::size_t index, std::vector<Feature>& features) const
{
  const NeighbourList& near = neighbourhood(query, index);
  if (near.ridges.empty())
    return;
  const Eigen::Vector3d& a = query.nodes[index];
  const Eigen::Vector3d& b = query.nodes[index + 1];
  const std::size_t begin = features.size();
  const double limit_begin = limitAt(query, index);
  const double limit_end = limitAt(query, index + 1);
  Feature feature;
  const double taper = query.radius[index + 1] - query.radius[index];
  std::optional<geometry::TaperedSegment> cone;
  if (taper != 0.0)
    cone.emplace(a, b, taper);
  const double limit = std::max(limit_begin, limit_end);
  const auto look = [&](int wall_edge)
  {
    double distance = 0.0;
    if (!crossing(a, b, cone, wall_edge, limit, feature, distance))
      return;
    const double t = feature.parameter;
    if (feature.gap > (1.0 - t) * limit_begin + t * limit_end)
      return;
    feature.gap -= (1.0 - t) * query.radius[index] + t * query.radius[index + 1];
    feature.edge = query.first_node + static_cast<int>(index);
    const auto same = [&feature](const Feature& other) { return other.id == feature.id; };
    // Mesh edges share their corners; an edge itself comes once.
    if (feature.id % 3 == kEdge ||
        std::none_of(features.begin() + static_cast<std::ptrdiff_t>(begin), features.end(), same))
      features.push_back(feature);
  };
  forEachInSight(near.ridges, EdgePacket::Place(a, b, taper, near.begin, limit, near.moved), look);
}

/** Closest point of the surface of a wire's edge ab, off its ends, to a reflex edge of the wall, where it is a local
 *  minimum. @param cone the wire's edge where it tapers */
bool Detector::crossing(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const std::optional<geometry::TaperedSegment>& cone, int wall_edge, double limit,
                        Feature& feature, double& distance) const
{
  const WallEdge& edge = wall_.edges[wall_edge];
  const Eigen::Vector3d& end0 = wall_.vertices[edge.vertices[0]];
  const Eigen::Vector3d& end1 = wall_.vertices[edge.vertices[1]];
  const geometry::SegmentPair pair =
      cone ? geometry::closestPointsOfCone(*cone, end0, end1) : geometry::closestPointsOfSegments(a, b, end0, end1);
  if (pair.first <= kEnd || pair.first >= 1.0 - kEnd)
    return false;
  feature.point = end0 + pair.second * (end1 - end0);
  const Eigen::Vector3d axis = a + pair.first * (b - a);
  const Eigen::Vector3d offset = axis - feature.point;
  distance = offset.norm();
  if (distance > limit)
    return false;
  const bool at_vertex = pair.second <= 0.0 || pair.second >= 1.0;
  const int vertex = edge.vertices[pair.second <= 0.0 ? 0 : 1];
  const Eigen::Vector3d& inward = at_vertex ? wall_.vertex_normals[vertex] : edge.normal;
  // The tissue behind a reflex edge is the wedge behind both triangles' planes.
  const bool inside = at_vertex ? offset.dot(inward) >= 0.0
                                : offset.dot(wall_.normals[edge.triangles[0]]) >= 0.0 ||
                                      offset.dot(wall_.normals[edge.triangles[1]]) >= 0.0;
  const double wide = distance < kWidestWire ? kConeSlackOfAngle * edge.reflex_angle : 0.0;
  const double slack = std::max(kConeSlack, wide) * distance;
  if (at_vertex ? !vertexIsMinimum(vertex, offset)
                : inside && (offset.dot(edge.into_triangle[0]) > slack || offset.dot(edge.into_triangle[1]) > slack))
    return false;
  if (!inside && (distance > kOutsideCrossing || signedDistance(axis, edge.triangles[0]) > 0.0))
    return false;
  const double sign = inside ? 1.0 : -1.0;
  feature.normal = distance > kOnRidge ? Eigen::Vector3d((sign / distance) * offset) : inward;
  feature.gap = sign * distance;
  feature.parameter = pair.first;
  feature.triangle = edge.triangles[0];
  feature.stiffness = law_.stiffness;
  feature.id = at_vertex ? featureId(vertex, kVertex) : featureId(wall_edge, kEdge);
  return true;
}

/** Distance from a node to the wall, or @p farthest where that is less; within radius + margin that to what it may
 * touch, which is listed already [m]. */
double Detector::wallDistance(const Query& query, std::size_t index, double farthest)
{
  const Eigen::Vector3d& point = query.nodes[index];
  const double limit = query.radius[index] + query.margin[index];
  const double nearest = nearestListed(neighbourhood(query, index), point, limit);
  if (nearest <= limit)
    return nearest;
  int& near = nearest_[static_cast<std::size_t>(query.first_node) + index];
  const Bvh::Nearest found = bvh_.nearest(point, farthest, near);
  near = found.triangle >= 0 ? found.triangle : near;
  return found.distance;
}

void Detector::freeDistances(const Query& query, double wanted, ContactSet& set)
{
  begin(query, set);
  renewLists(query);
  const std::size_t whole = static_cast<std::size_t>(query.first_node) + query.nodes.size();
  if (nearest_.size() < whole)
    nearest_.resize(whole, -1);
  // The distance to the wall is 1-Lipschitz, so both ends bound it along the edge: (d0 + d1 − |e|)/2.
  set.free_distance.resize(query.nodes.empty() ? 0 : query.nodes.size() - 1);
  // How far it is looked from a node: an edge whose ends are both at least so far off has what is wanted. Where one end
  // is closer the other one may count as closer than it is: looking farther costs more than a motion cut short.
  double room = 0.0;
  for (std::size_t i = 1; i < query.nodes.size(); ++i)
    room = std::max(
        room, 0.5 * (query.nodes[i] - query.nodes[i - 1]).norm() + std::max(query.radius[i - 1], query.radius[i]));
  const double farthest = wanted + room;
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
