#pragma once

#include <cstddef>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace endovascular_sim::image
{

/** Regular grid of voxels in the patient frame: x to the left, y to the back, z to the head of the patient (DICOM's
 * LPS, in metres). Index (i, j, k) is the centre of a voxel; i changes fastest in memory. */
struct VolumeGrid
{
  Eigen::Vector3i size = Eigen::Vector3i::Zero();      ///< number of voxels along i, j and k
  Eigen::Vector3d spacing = Eigen::Vector3d::Ones();   ///< distance of the centres [m]
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();    ///< centre of voxel (0, 0, 0) [m]
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< unit vectors of i, j and k in its columns, orthogonal

  /** Number of voxels. */
  std::size_t voxels() const;

  /** Place of a voxel in memory. */
  std::size_t offset(int i, int j, int k) const
  {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size.y()) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(size.x()) +
           static_cast<std::size_t>(i);
  }

  /** Position of an index, which may lie between voxels [m]. */
  Eigen::Vector3d position(const Eigen::Vector3d& index) const;

  /** Index of a position [m], which may lie between voxels; inverse of position(). */
  Eigen::Vector3d index(const Eigen::Vector3d& position) const
  {
    return (axes.transpose() * (position - origin)).cwiseQuotient(spacing);
  }

  /** Corners of the axis-aligned box of all centres [m]. */
  Eigen::AlignedBox3d bounds() const;
};

/** Checks a grid that comes from a file.
 *  @param file name of the file in errors
 *  @throws InputError for a size below 2 voxels, a spacing that is not finite or beyond 1 µm to 50 mm, an origin beyond
 *          10 m, and axes that are not orthogonal unit vectors */
void requireValid(const VolumeGrid& grid, const std::string& file);

}  // namespace endovascular_sim::image
