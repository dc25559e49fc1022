#pragma once

#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "patient/volume/density_volume.h"

namespace endovascular_sim::patient
{

/** One byte per voxel in storage order: 1 for marked voxels. */
using VoxelMask = std::vector<std::uint8_t>;

/** Marks the voxels whose centre lies inside a closed, outward oriented mesh of the patient frame.
 *
 *  Along each line of voxels in x the surface is crossed at signed positions; a centre is inside where the winding
 * number is positive. Crossings are decided in integers with a fill rule, as in vesselPathLength(), so that a line
 * through an edge or a vertex crosses exactly one of the adjacent faces. The cost is linear in the triangles and in the
 * marked voxels. */
VoxelMask lumenMask(const image::VolumeGrid& grid, const geometry::TriangleMesh& mesh);

/** Mask widened by @p voxels in each direction of the lattice (a cube). */
VoxelMask dilated(const image::VolumeGrid& grid, const VoxelMask& mask, int voxels);

/** Replaces contrast medium by blood: every voxel of the mask widened by @p rim voxels becomes blood (1060 kg/m³, no
 * bone), and in the rim only those denser than blood. The rim takes the voxels that the wall divides. Calcifications
 * within the rim are lost. */
void replaceByBlood(DensityVolume& volume, const VoxelMask& lumen, int rim = 1);

}  // namespace endovascular_sim::patient
