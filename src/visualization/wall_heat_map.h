#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "geometry/kd_tree.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::visualization
{

/** Triangles of the wall to be drawn as a heat map: three corners each. */
struct HeatPatch
{
  std::vector<Eigen::Vector3d> corners;  ///< slightly inside the lumen [m]
  std::vector<double> values;            ///< at each corner, in the unit of what was given
};

/** Spreads what single triangles have borne over the wall around them, so that it can be seen: a triangle is smaller
 *  than a pixel. For pictures only. */
class WallHeat
{
public:
  /** @param mesh oriented, normals out of the lumen
   *  @param radius over which a triangle's value fades to zero [m]
   *  @param inset of the drawn triangles from the wall, so that they do not flicker with it [m] */
  WallHeat(geometry::TriangleMesh mesh, double radius, double inset);
  WallHeat(const WallHeat&) = delete;  // the tree looks at the mesh
  WallHeat& operator=(const WallHeat&) = delete;

  /** At a vertex the largest of the values around, each times (1 − (distance/radius)²)², but never less than that of a
   *  triangle at its own corners. The wall of another vessel and the opposite wall, which face another way, stay cold.
   *  @param triangles indices; those that the mesh does not have are left out
   *  @param values positive, one per triangle
   *  @return every triangle with a warm corner */
  HeatPatch patch(const std::vector<std::uint32_t>& triangles, const std::vector<float>& values) const;

private:
  Eigen::Vector3d normalOf(const Eigen::Vector3i& corners) const;

  geometry::TriangleMesh mesh_;
  double radius_;
  std::vector<Eigen::Vector3d> normals_;  ///< of the vertices, out of the lumen, unit
  std::vector<Eigen::Vector3d> inset_;    ///< the vertices as they are drawn [m]
  geometry::KdTree tree_;
};

}  // namespace endovascular_sim::visualization
