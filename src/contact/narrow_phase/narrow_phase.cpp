#include "contact/narrow_phase/narrow_phase.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "contact/narrow_phase/normal_cone.h"
#include "geometry/closest_point_on_triangle.h"

namespace endovascular_sim::contact
{
namespace
{

constexpr double kOutsideEdge = 0.4e-3;      // m: largest depth of a wire's edge behind a reflex edge
constexpr double kConeTolerance = 1e-12;     // m
constexpr double kWidestWire = 0.6e-3;       // m from a wire's axis up to which kConeSlackOfAngle applies
constexpr double kOnFeature = 1e-12;         // m: closer offsets have no direction
constexpr double kLeastClearance = 0.05e-3;  // m
constexpr double kEnd = 1e-3;                // share of a wire's edge at its ends that is left to the nodes' features

/** Sets normal and gap from the offset. @param inward pseudo-normal of the feature, used where the offset is zero */
void setNormalAndGap(const Eigen::Vector3d& offset, const Eigen::Vector3d& inward, NarrowPhase::Minimum& minimum)
{
  const double sign = minimum.outside ? -1.0 : 1.0;
  const double distance = minimum.distance;
  minimum.feature.normal = distance > kOnFeature ? Eigen::Vector3d((sign / distance) * offset) : inward;
  minimum.feature.gap = sign * distance;
}

}  // namespace

NarrowPhase::WireEdge::WireEdge(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double taper_)
  : begin(a), end(b), taper(taper_)
{
  if (taper != 0.0)
    cone.emplace(a, b, taper);
}

bool NarrowPhase::faceFeature(const Eigen::Vector3d& point, int triangle, double cutoff, Minimum& minimum) const
{
  Feature& feature = minimum.feature;
  const TriangleSlab& slab = bounds_.triangle(triangle);
  const Eigen::Array4d heights = slab.heights(point);
  const double height = heights[0];
  if (height * height > cutoff * cutoff)
    return false;
  const Eigen::Vector3d normal = slab.normal();
  feature.triangle = triangle;
  if (TriangleSlab::distanceBeyond(heights) < -kOffTriangle)
  {
    minimum.distance = std::abs(height);
    minimum.outside = height < 0.0;
    feature.point = point - height * normal;
    feature.normal = normal;
    feature.gap = height;
    feature.id = featureId(triangle, FeatureKind::kFace);
    return true;
  }
  const Eigen::Vector3i& corners = wall_.triangles[triangle];
  geometry::TrianglePoint closest = geometry::closestPointOnTriangle(
      point, wall_.vertices[corners[0]], wall_.vertices[corners[1]], wall_.vertices[corners[2]]);
  if (closest.edge >= 0)
    closest.point = closestPointOnEdge(point, wall_.triangle_edges[triangle][closest.edge]);
  const Eigen::Vector3d offset = point - closest.point;
  const double squared = offset.squaredNorm();
  if (squared > cutoff * cutoff)
    return false;
  minimum.distance = std::sqrt(squared);
  feature.point = closest.point;
  // A foot on the border between coplanar triangles counts as a face of each: neither would report it otherwise.
  const bool foot_inside = closest.edge < 0 && closest.vertex < 0;
  if (foot_inside || (height >= 0.0 && (offset - height * normal).squaredNorm() < kConeTolerance * kConeTolerance))
  {
    minimum.outside = height < 0.0;
    feature.normal = normal;
    feature.gap = height;
    feature.id = featureId(triangle, FeatureKind::kFace);
    return true;
  }
  return borderFeature(triangle, closest.edge, closest.vertex, offset, minimum);
}

/** Completes a local minimum on the border of a triangle.
 *  @param border_edge, border_vertex which edge or vertex of the triangle is closest; the other is −1
 *  @param offset vector from the closest point to the queried point [m] */
bool NarrowPhase::borderFeature(int triangle, int border_edge, int border_vertex, const Eigen::Vector3d& offset,
                                Minimum& minimum) const
{
  Feature& feature = minimum.feature;
  if (border_edge >= 0)
  {
    const int e = wall_.triangle_edges[triangle][border_edge];
    const WallEdge& edge = wall_.edges[e];
    minimum.outside = offset.dot(edge.normal) < 0.0;
    if ((!minimum.outside && edge.reflex_angle <= 0.0) || offset.dot(edge.into_triangle[0]) > kConeTolerance ||
        offset.dot(edge.into_triangle[1]) > kConeTolerance)
      return false;
    feature.triangle = edge.triangles[0];
    feature.id = featureId(e, FeatureKind::kEdge);
    setNormalAndGap(offset, edge.normal, minimum);
    return true;
  }
  const int vertex = wall_.triangles[triangle][border_vertex];
  const Eigen::Vector3d& inward = wall_.vertex_normals[vertex];
  minimum.outside = offset.dot(inward) < 0.0;
  if ((!minimum.outside && !wall_.vertex_reflex[vertex]) || !vertexIsMinimum(vertex, offset))
    return false;
  feature.triangle = wall_.ownerOf(vertex);
  feature.id = featureId(vertex, FeatureKind::kVertex);
  setNormalAndGap(offset, inward, minimum);
  return true;
}

/** Closest point of a mesh edge: bit for bit the same from both of its triangles. */
Eigen::Vector3d NarrowPhase::closestPointOnEdge(const Eigen::Vector3d& point, int wall_edge) const
{
  const WallEdge& edge = wall_.edges[wall_edge];
  const Eigen::Vector3d& begin = wall_.vertices[edge.vertices[0]];
  const Eigen::Vector3d along = wall_.vertices[edge.vertices[1]] - begin;
  return begin + geometry::clampedParameter((point - begin).dot(along) / along.squaredNorm()) * along;
}

/** Normal-cone test of a vertex: no edge at the vertex leads closer to the point. */
bool NarrowPhase::vertexIsMinimum(int vertex, const Eigen::Vector3d& offset) const
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

bool NarrowPhase::edgeEdgeFeature(const WireEdge& wire_edge, int wall_edge, double cutoff, Minimum& minimum) const
{
  Feature& feature = minimum.feature;
  const WallEdge& edge = wall_.edges[wall_edge];
  const Eigen::Vector3d& end0 = wall_.vertices[edge.vertices[0]];
  const Eigen::Vector3d& end1 = wall_.vertices[edge.vertices[1]];
  const geometry::SegmentPair pair =
      wire_edge.cone ? geometry::closestPointsOfCone(*wire_edge.cone, end0, end1)
                     : geometry::closestPointsOfSegments(wire_edge.begin, wire_edge.end, end0, end1);
  if (pair.first <= kEnd || pair.first >= 1.0 - kEnd)
    return false;
  feature.point = end0 + pair.second * (end1 - end0);
  const Eigen::Vector3d offset = wire_edge.pointAt(pair.first) - feature.point;
  const double distance = offset.norm();
  if (distance > cutoff)
    return false;
  minimum.distance = distance;
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
  if (!inside && distance > kOutsideEdge)
    return false;
  minimum.outside = !inside;
  setNormalAndGap(offset, inward, minimum);
  feature.parameter = pair.first;
  feature.triangle = edge.triangles[0];
  feature.id = at_vertex ? featureId(vertex, FeatureKind::kVertex) : featureId(wall_edge, FeatureKind::kEdge);
  return true;
}

double NarrowPhase::clearanceRadius(const Feature& feature, const Eigen::Vector3d& wire_edge, double radius) const
{
  const double infinity = std::numeric_limits<double>::infinity();
  if (kindOf(feature) != FeatureKind::kFace)
    return infinity;
  const Eigen::Vector3d across = feature.normal.cross(wire_edge);
  const double curvature = across.dot(wall_.curvature[feature.triangle] * across) / across.squaredNorm();
  // A wire as wide as the lumen still has a clearance; a wire perpendicular to the wall has no direction across.
  return curvature > 0.0 ? std::max(kLeastClearance, 1.0 / curvature - radius) : infinity;
}

}  // namespace endovascular_sim::contact
