#pragma once

#include <vector>

#include "segmentation/labels/voxel_mask.h"

namespace endovascular_sim::segmentation
{

/** Smooth signed function of a mask, negative inside, in voxels from the surface.
 *
 *  The mask M is filtered by 2G − G∗G, with a Gaussian G of one voxel. Its second moment is zero, so that a curved wall
 *  moves by the fourth order of the curvature only: a tube of radius 2 voxels by −0.07 voxels. The wall is then moved
 *  until the smooth surface encloses as much volume as the mask, not only on the whole, but within every window of a
 *  Gaussian of 2.5 voxels. */
std::vector<float> smoothField(const VoxelMask& mask);

/** Gives every value the sign of its voxel: the surface then separates the voxels of the mask from the others. */
void imposeSigns(const VoxelMask& mask, std::vector<float>& field);

}  // namespace endovascular_sim::segmentation
