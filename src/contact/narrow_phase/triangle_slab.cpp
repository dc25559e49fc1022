#include "contact/narrow_phase/triangle_slab.h"

#include <cmath>

#include "contact/narrow_phase/normal_cone.h"

namespace endovascular_sim::contact
{
namespace
{

/** Whether a triangle at the vertex is turned by about a right angle or more against another one there. */
bool foldsAt(const Wall& wall, int vertex, int triangle)
{
  const double least = std::cos(kSharp);
  const auto turned = [&wall, triangle, least](int other)
  { return wall.normals[other].dot(wall.normals[triangle]) < least; };
  const std::vector<int>& edges = wall.vertex_edges[vertex];
  return std::any_of(edges.begin(), edges.end(),
                     [&](int e) { return turned(wall.edges[e].triangles[0]) || turned(wall.edges[e].triangles[1]); });
}

/** At a reflex edge the point lies between both triangles' normals, at a reflex vertex in the vertex's cone. The foot's
 *  distance from a line along an edge is at most its distance from the triangle, whatever the corners' angles. Where
 *  the lumen is convex, the closest feature of a point behind the wall is behind the triangle too, unless the wall
 *  folds there by more than a right angle. Features of other owners are found from their owners. */
void setSlopes(const Wall& wall, int triangle, TriangleSlab& slab)
{
  double widest_edge = 0.0;    // rad
  double widest_corner = 0.0;  // rad
  for (int k = 0; k < 3; ++k)
  {
    const WallEdge& edge = wall.edges[wall.triangle_edges[triangle][k]];
    if (edge.triangles[0] == triangle)
      widest_edge = std::max(widest_edge, edge.reflex_angle > -kSharp ? edge.reflex_angle : M_PI);
    const int vertex = wall.triangles[triangle][k];
    if (wall.ownerOf(vertex) != triangle)
      continue;
    if (wall.vertex_reflex[vertex] != 0)
      widest_corner = std::max(
          widest_corner, angleBetween(wall.normals[triangle], wall.vertex_normals[vertex]) + wall.vertex_cone[vertex]);
    else if (foldsAt(wall, vertex, triangle))
      widest_corner = M_PI;
  }
  slab.edge_slope = coneSlope(widest_edge);
  slab.corner_slope = coneSlope(widest_corner);
}

}  // namespace

void setTriangleSlab(const Wall& wall, int triangle, TriangleSlab& slab)
{
  setSlopes(wall, triangle, slab);
  const auto set = [&slab](int lane, const Eigen::Vector3d& normal, double offset)
  {
    for (int axis = 0; axis < 3; ++axis)
      slab.planes[axis][lane] = normal[axis];
    slab.planes[3][lane] = -offset;
  };
  set(0, wall.normals[triangle], wall.plane_offsets[triangle]);
  for (int k = 0; k < 3; ++k)
  {
    const int vertex = wall.triangles[triangle][k];
    const int e = wall.triangle_edges[triangle][k];
    const WallEdge& edge = wall.edges[e];
    const int side = edge.triangles[0] == triangle ? 0 : 1;
    set(k + 1, edge.into_triangle[side], edge.into_triangle[side].dot(wall.vertices[vertex]));
    slab.own_edges[k] = side == 0 && edge.reflex_angle > kReflexAngle ? e : -1;
  }
}

}  // namespace endovascular_sim::contact
