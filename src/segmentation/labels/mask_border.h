#pragma once

#include <vector>

#include <Eigen/Core>

#include "segmentation/labels/voxel_mask.h"

namespace endovascular_sim::segmentation
{

/** End of a vessel at the border of its image. */
struct BorderEnd
{
  Eigen::Vector3d point = Eigen::Vector3d::Zero();     ///< centre of the lumen on the faces of the outermost voxels [m]
  Eigen::Vector3d outward = Eigen::Vector3d::UnitZ();  ///< unit normal of the border
  double radius = 0.0;                                 ///< of the circle with the area of the lumen [m]
  double reach = 0.0;                                  ///< distance of the end of its continuation, at most [m]
};

/** Mask with empty voxels on all sides.
 *  @param margin number of layers */
VoxelMask padded(const VoxelMask& mask, int margin);

/** Ends of a vessel at the border of the image. A patch of the outermost layer is an end if it is about as wide as the
 * vessel behind it and not elongated; a vessel that runs along the border only touches it.
 *  @param mask with an empty margin; receives a straight continuation of the vessel behind every end, so that it
 *         reaches the border with its full width
 *  @param margin layers outside of the image
 *  @param touches receives the centres of the patches that are no end [m] */
std::vector<BorderEnd> continueBeyondBorder(VoxelMask& mask, int margin, std::vector<Eigen::Vector3d>& touches);

}  // namespace endovascular_sim::segmentation
