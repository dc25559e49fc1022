#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Surface of the space that a set of triangles shuts off from the outside. */
struct UnitedSurface
{
  geometry::TriangleMesh mesh;           ///< closed, two-manifold, outward; triangles as long as a voxel
  std::vector<Eigen::Vector3d> cleared;  ///< places where sheets that touched were parted by a voxel [m]
};

/** Unites pieces that overlap, however their faces are turned: the signed distance on a grid, whose inside is what a
 *  flood from the outside does not reach (OpenVDB, tools::meshToVolume), and its zero level (tools::volumeToMesh).
 *  Walls inside of other pieces vanish, gaps narrower than a voxel close.
 * Every piece that is left is in the mesh.
 *  @param triangles no holes wider than a voxel (closeHoles); they need not fit together, nor be turned alike
 *  @param voxel edge of the grid's cells [m]; what is thinner than twice that may be lost
 *  @throws InputError when nothing is shut off, or sheets cannot be parted */
UnitedSurface unite(const geometry::TriangleMesh& triangles, double voxel);

}  // namespace endovascular_sim::vessel
