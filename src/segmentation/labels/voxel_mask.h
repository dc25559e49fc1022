#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::segmentation
{

/** Set of voxels on a grid; i changes fastest. */
struct VoxelMask
{
  Eigen::Vector3i size = Eigen::Vector3i::Zero();
  Eigen::Vector3d spacing = Eigen::Vector3d::Ones();  ///< [m]
  Eigen::Vector3d first = Eigen::Vector3d::Zero();    ///< centre of voxel (0, 0, 0) in the grid frame [m]
  std::vector<std::uint8_t> inside;                   ///< 1 or 0

  VoxelMask() = default;
  VoxelMask(const Eigen::Vector3i& voxels, const Eigen::Vector3d& distance, const Eigen::Vector3d& begin)
    : size(voxels), spacing(distance), first(begin), inside(count(voxels), 0)
  {
  }

  static std::size_t count(const Eigen::Vector3i& size)
  {
    return static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(size.z());
  }

  std::size_t offset(const Eigen::Vector3i& voxel) const
  {
    return (static_cast<std::size_t>(voxel.z()) * static_cast<std::size_t>(size.y()) +
            static_cast<std::size_t>(voxel.y())) *
               static_cast<std::size_t>(size.x()) +
           static_cast<std::size_t>(voxel.x());
  }

  Eigen::Vector3i voxelOf(std::size_t offset) const
  {
    const auto nx = static_cast<std::size_t>(size.x());
    const auto ny = static_cast<std::size_t>(size.y());
    return {static_cast<int>(offset % nx), static_cast<int>(offset / nx % ny), static_cast<int>(offset / nx / ny)};
  }

  bool holds(const Eigen::Vector3i& voxel) const
  {
    return (voxel.array() >= 0).all() && (voxel.array() < size.array()).all();
  }

  bool at(const Eigen::Vector3i& voxel) const { return inside[offset(voxel)] != 0; }

  /** Centre of a voxel in the grid frame [m]. */
  Eigen::Vector3d centreOf(std::size_t offset) const
  {
    return first + voxelOf(offset).cast<double>().cwiseProduct(spacing);
  }

  /** Number of voxels inside. */
  std::size_t voxels() const;

  /** Volume of a voxel [m³]. */
  double voxelVolume() const { return spacing.prod(); }
};

/** Distance of every voxel from the nearest one with a value [m].
 *  @param value 1: from the inside, 0: from the outside */
std::vector<float> distancesFrom(const VoxelMask& mask, std::uint8_t value);

}  // namespace endovascular_sim::segmentation
