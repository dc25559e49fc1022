#include "contact/narrow_phase/edge_bounds.h"

#include <algorithm>
#include <cmath>

#include "contact/narrow_phase/normal_cone.h"

namespace endovascular_sim::contact
{
namespace
{

/** Slope of the edge's cone: the offset at a minimum lies between the triangles' normals or in an end's vertex cone. */
double boundOfCone(const Wall& wall, const WallEdge& edge)
{
  const double slack = std::max(kConeSlack, kConeSlackOfAngle * std::abs(edge.reflex_angle));
  double widest = 0.5 * edge.reflex_angle + 1.1 * slack;  // rad
  for (int vertex : edge.vertices)
    widest = std::max(widest, wall.vertex_cone[vertex] + angleBetween(edge.normal, wall.vertex_normals[vertex]));
  return coneSlope(std::abs(edge.reflex_angle) > kSharp ? M_PI : widest);
}

}  // namespace

EdgeBounds makeEdgeBounds(const Wall& wall, const WallEdge& edge)
{
  const Eigen::Vector3d& begin = wall.vertices[edge.vertices[0]];
  const Eigen::Vector3d& end = wall.vertices[edge.vertices[1]];
  const Eigen::Vector3d half = 0.5 * (end - begin);
  return {
      0.5 * (begin + end), edge.normal, half, half.norm(), boundOfCone(wall, edge), edge.reflex_angle > kReflexAngle};
}

}  // namespace endovascular_sim::contact
