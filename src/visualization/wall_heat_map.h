#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "geometry/kd_tree.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::visualization
{

/** Triangles of a heat map of the wall, with three corners each. */
struct HeatPatch
{
  std::vector<Eigen::Vector3d> corners;  ///< corners, slightly inside the lumen [m]
  std::vector<double> values;            ///< value at each corner, in the unit of the input
};

/** Heat map of values of single triangles, smoothed over the surrounding wall. A single triangle is smaller than a
 *  pixel. For display only. */
class WallHeatMap
{
public:
  /** @param mesh oriented mesh with normals out of the lumen
   *  @param radius distance over which a triangle's value decays to zero [m]
   *  @param inset distance of the displayed triangles from the wall, against z-fighting [m] */
  WallHeatMap(geometry::TriangleMesh mesh, double radius, double inset);
  WallHeatMap(const WallHeatMap&) = delete;  // the tree refers to the mesh
  WallHeatMap& operator=(const WallHeatMap&) = delete;

  /** Computes the heat map.
   *
   *  The value of a vertex is the maximum over the triangles within the radius of value·(1 − (distance/radius)²)², and
   *  at least the value of each adjacent triangle. Triangles with the opposite orientation, such as the opposite wall,
   *  do not contribute.
   *  @param triangles indices of the triangles; invalid ones are ignored
   *  @param values positive values, one per triangle
   *  @return all triangles with a positive value at a corner */
  HeatPatch patch(const std::vector<std::uint32_t>& triangles, const std::vector<float>& values) const;

private:
  Eigen::Vector3d normalOf(const Eigen::Vector3i& corners) const;

  geometry::TriangleMesh mesh_;
  double radius_;
  std::vector<Eigen::Vector3d> normals_;  ///< unit normals of the vertices, out of the lumen
  std::vector<Eigen::Vector3d> inset_;    ///< displayed vertices, moved into the lumen [m]
  geometry::KdTree tree_;
};

}  // namespace endovascular_sim::visualization
