#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "segmentation/labels/voxel_mask.h"

namespace endovascular_sim::segmentation
{

/** Piece of a mask that is not connected to the vessel. */
struct Island
{
  std::size_t voxels = 0;
  double volume = 0.0;                                 ///< [m³]
  double gap = 0.0;                                    ///< least distance of its voxels from those of the vessel [m]
  Eigen::Vector3d location = Eigen::Vector3d::Zero();  ///< its deepest voxel, grid frame [m]
};

/** Changes of a mask until its surface is a sphere. Positions are those of the grid frame [m]. */
struct MaskChanges
{
  std::vector<Island> islands;             ///< removed, by decreasing size
  std::vector<Eigen::Vector3d> joints;     ///< gaps between pieces that were closed
  std::size_t cavities = 0;                ///< enclosed hollows, which were filled
  std::size_t cavity_voxels = 0;           ///< their voxels
  std::vector<Eigen::Vector3d> tunnels;    ///< narrow holes through the vessel that were filled
  std::vector<Eigen::Vector3d> cut_loops;  ///< wide loops and touching vessels that were cut where they are thinnest
};

/** Makes one ball of a mask, in the topological sense: joins pieces that a gap of at most two voxels separates, keeps
 * the largest piece, fills cavities and tunnels, and cuts loops. A tunnel is a hole that is narrower than the vessel
 * beside it.
 *  @param wanted points of the grid frame; the piece that is nearest to the first one is kept, if there is one
 *  @pre the outermost two layers of voxels are outside */
MaskChanges repairMask(VoxelMask& mask, const std::vector<Eigen::Vector3d>& wanted);

/** Cuts all handles of a mask of one piece without cavities.
 *  @return positions of the cuts */
std::vector<Eigen::Vector3d> cutLoops(VoxelMask& mask);

}  // namespace endovascular_sim::segmentation
