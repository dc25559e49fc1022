#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fluoroscopy/projection/areal_density_image.h"
#include "fluoroscopy/projection/x_ray_geometry.h"
#include "patient/volume/density_volume.h"

namespace endovascular_sim::fluoroscopy
{

/** Projection of a density volume: integrals of tissue and bone along rays from the source to the detector plane.
 *
 *  Interpolation is trilinear between voxel centres. A ray is sampled where it meets the lattice planes of one axis,
 * the one nearest to the image's central ray; there the interpolation is bilinear (P. M. Joseph, IEEE Trans. Med.
 * Imaging 1:192, 1982). Each sample has the length of ray between two planes, and the first and last one the length up
 * to the volume's boundary. The sample positions are fixed in the volume, so that they cause no rings, and every length
 * is a continuous function of the ray. Rays that are inclined by more than 60° to this axis, in very wide fields, use
 * their own nearest axis.
 *
 *  Weights have 8 bits per axis and sums are integers: results are equal bit for bit on every machine.
 *
 *  The projection keeps its own copy of the voxels, in which neighbours along the patient's z are adjacent. Rays of one
 * image column are computed after each other, so that they share cache lines in all usual views. */
class VolumeProjection
{
public:
  /** @param volume copied; it takes 2 bytes per voxel here too, and the caller need not keep it */
  explicit VolumeProjection(const patient::DensityVolume& volume);

  const image::VolumeGrid& grid() const { return grid_; }

  /** Voxels as DensityVolume holds them, in an order of their own. */
  const std::vector<std::uint16_t>& voxels() const { return voxels_; }

  /** Distances of neighbours along the axes of the grid in voxels(). */
  const std::array<std::ptrdiff_t, 3>& strides() const { return stride_; }

  /** Box of all centres but those of air, and of their neighbours [voxel]. */
  const Eigen::AlignedBox3d& occupied() const { return occupied_; }

  /** Projection with @p samples × @p samples rays at the centres of equal squares of the detector.
   *  @throws InputError for samples outside of 1 to 4096 */
  ArealDensityImage project(const XRayGeometry& geometry, int samples) const;

  /** The rows [begin, end) of project(), written into @p image of the same number of samples. */
  void projectRows(const XRayGeometry& geometry, int begin, int end, ArealDensityImage& image) const;

private:
  image::VolumeGrid grid_;
  std::array<std::ptrdiff_t, 3> stride_;  ///< of the axes of the grid in voxels_
  std::vector<std::uint16_t> voxels_;
  Eigen::AlignedBox3d occupied_;  ///< box of all centres but those of air, and of their neighbours [voxel]
};

}  // namespace endovascular_sim::fluoroscopy
