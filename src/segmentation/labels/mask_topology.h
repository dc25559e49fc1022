#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "segmentation/labels/voxel_mask.h"

namespace endovascular_sim::segmentation
{

// Voxels are vertices of Freudenthal's triangulation of the grid, whose tetrahedra are those of the surface
// (surface/lattice_surface.h). The connectivity of a mask, 14 neighbours for the inside as well as for the outside, is
// therefore that of its surface.

constexpr std::size_t kNeighbours = 14;

/** Steps to the neighbours of a voxel. */
const std::array<Eigen::Vector3i, kNeighbours>& neighbourSteps();

/** Connected components of the voxels with a value.
 *  @param value 1: of the inside, 0: of the outside
 *  @param component receives the number of its component per voxel, from 0 in the order of the voxels; −1 elsewhere
 *  @return number of voxels of each component */
std::vector<std::size_t> componentsOf(const VoxelMask& mask, std::uint8_t value, std::vector<int>& component);

/** Number of handles of a mask: components + cavities − Euler characteristic.
 *  @pre the outermost voxels are outside */
long handlesOf(const VoxelMask& mask);

/** Largest subset of a mask that grows from seeds without a change of its topology: a seed voxel becomes a ball, the
 * frame of a box becomes a box with one cavity. Voxels are added by decreasing depth, so that a handle is cut where it
 * is thinnest. A voxel may be added if its neighbours inside the subset are connected, and those outside too (a simple
 * point).
 *  @param seeds voxels of the mask
 *  @param depth priority of every voxel */
VoxelMask grown(const VoxelMask& mask, const std::vector<std::size_t>& seeds, const std::vector<float>& depth);

}  // namespace endovascular_sim::segmentation
