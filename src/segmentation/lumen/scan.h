#pragma once

#include <vector>

#include <string>

#include <Eigen/Core>

#include "image/volume.h"

namespace endovascular_sim::segmentation
{

/** Image of a patient in the frame of its grid.
 *
 *  The voxels are stored in the order that comes closest to the patient frame (x left, y back, z head). The grid frame
 * has its origin at the first voxel and the axes of the grid. A segmentation computed in the grid frame is therefore
 * the same for permuted, flipped and oblique axes of an image file. */
class Scan
{
public:
  explicit Scan(image::Volume volume);

  image::Modality modality() const { return volume_.modality; }
  const Eigen::Vector3i& size() const { return volume_.grid.size; }
  const Eigen::Vector3d& spacing() const { return volume_.grid.spacing; }

  /** Stored volume, with voxels in the canonical order. */
  const image::Volume& volume() const { return volume_; }

  double value(int i, int j, int k) const { return volume_.scale * volume_.stored[volume_.grid.offset(i, j, k)]; }

  /** Value by trilinear interpolation; beyond the border that of the border.
   *  @param p point of the grid frame [m] */
  double at(const Eigen::Vector3d& p) const;

  /** True between the centres of the outermost voxels. */
  bool contains(const Eigen::Vector3d& p) const;

  /** Nearest voxel of a point of the grid frame. */
  Eigen::Vector3i voxelOf(const Eigen::Vector3d& p) const;

  /** Centre of a voxel in the grid frame [m]. */
  Eigen::Vector3d centreOf(const Eigen::Vector3i& voxel) const
  {
    return voxel.cast<double>().cwiseProduct(volume_.grid.spacing);
  }

  Eigen::Vector3d toPatient(const Eigen::Vector3d& p) const { return volume_.grid.origin + volume_.grid.axes * p; }
  Eigen::Vector3d toGrid(const Eigen::Vector3d& p) const
  {
    return volume_.grid.axes.transpose() * (p - volume_.grid.origin);
  }

private:
  image::Volume volume_;
  Eigen::Vector3d inverse_spacing_;
};

/** Volume with its voxels in the order that comes closest to the patient frame. The positions of the voxels stay. */
image::Volume canonical(image::Volume volume);

}  // namespace endovascular_sim::segmentation
