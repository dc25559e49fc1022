#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"
#include "segmentation/labels/voxel_mask.h"

namespace endovascular_sim::segmentation
{

/** Zero level of the field of a mask: closed, two-manifold, outward oriented; grid frame [m].
 *
 *  The topology is that of marching tetrahedra on the voxels. Every triangle is then divided into four, and the
 * vertices are moved onto the zero level of the field's cubic interpolation: chords of a voxel would take 2 % of the
 * volume of a tube of radius 2.5 voxels.
 *  @param mask grid of the field */
geometry::TriangleMesh fieldSurface(const VoxelMask& mask, const std::vector<float>& field);

}  // namespace endovascular_sim::segmentation
