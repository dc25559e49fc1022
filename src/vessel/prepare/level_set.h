#pragma once

#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Boundary of the volume that a set of triangles encloses. */
struct UnitedSurface
{
  geometry::TriangleMesh mesh;             ///< closed, two-manifold, outward oriented; edges about one voxel long
  std::vector<Eigen::Vector3d> separated;  ///< locations where touching sheets were separated by one voxel [m]
};

/** Union of overlapping components of any orientation, by the zero level of a signed distance grid. A flood fill from
 *  outside determines the sign (OpenVDB tools::meshToVolume and tools::volumeToMesh). Walls inside other components
 *  disappear, and gaps narrower than a voxel close. The mesh contains all resulting components.
 *  @param triangles triangle soup of any orientation, without holes wider than a voxel (closeHoles)
 *  @param voxel edge of the grid's cells [m]; features thinner than two voxels may be lost
 *  @throws InputError if no volume is enclosed, or touching sheets cannot be separated */
UnitedSurface unite(const geometry::TriangleMesh& triangles, double voxel);

}  // namespace endovascular_sim::vessel
