#include "patient/volume/density_volume.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"

namespace endovascular_sim::patient
{
namespace
{

constexpr double kMinSpacing = 5e-5;  // [m]
constexpr double kMaxSpacing = 5e-2;  // [m]

void check(const image::VolumeGrid& grid, const std::string& source)
{
  std::uint64_t voxels = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (grid.size[axis] < 2 || grid.size[axis] > DensityVolume::kMaxSide)
      throw InputError(source, "size", "must lie between 2 and 2048 voxels along each axis");
    if (!(grid.spacing[axis] >= kMinSpacing && grid.spacing[axis] <= kMaxSpacing))
      throw InputError(source, "spacing", "must lie between 0.00005 and 0.05 [m]; are the units metres?");
    voxels *= static_cast<std::uint64_t>(grid.size[axis]);
  }
  if (voxels > DensityVolume::kMaxVoxels)
    throw InputError(source, "size", "exceeds 2^30 voxels; crop the volume or increase its spacing");
  if (!grid.origin.allFinite())
    throw InputError(source, "origin", "must be finite [m]");
  const Eigen::Matrix3d gram = grid.axes.transpose() * grid.axes;
  if (!((gram - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-4))
    throw InputError(source, "axes",
                     "must be three orthogonal unit vectors; a sheared volume (gantry tilt) must be resampled");
}

int level(double density, double step)
{
  return static_cast<int>(std::clamp(std::floor(density / step + 0.5), 0.0, 255.0));
}

}  // namespace

DensityVolume::DensityVolume(const image::VolumeGrid& grid, const std::string& source) : grid_(grid)
{
  check(grid, source);
  voxels_.assign(grid.voxels(), 0);
}

std::uint16_t DensityVolume::encode(const Density& density)
{
  return static_cast<std::uint16_t>(level(density.tissue, kTissueStep) | (level(density.bone, kBoneStep) << 8));
}

Density DensityVolume::decode(std::uint16_t voxel)
{
  return {kTissueStep * (voxel & 0xff), kBoneStep * (voxel >> 8)};
}

Density DensityVolume::at(int x, int y, int z) const
{
  return decode(voxels_[grid_.offset(x, y, z)]);
}

void DensityVolume::set(int x, int y, int z, const Density& density)
{
  voxels_[grid_.offset(x, y, z)] = encode(density);
}

Density DensityVolume::interpolate(const Eigen::Vector3d& point) const
{
  const Eigen::Vector3d c = grid_.index(point);
  Eigen::Vector3i cell;
  Eigen::Vector3d fraction;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (!(c[axis] >= 0.0 && c[axis] <= grid_.size[axis] - 1))
      return {};
    cell[axis] = std::min(static_cast<int>(c[axis]), grid_.size[axis] - 2);
    fraction[axis] = c[axis] - cell[axis];
  }
  Density sum;
  for (int corner = 0; corner < 8; ++corner)
  {
    double weight = 1.0;
    Eigen::Vector3i voxel = cell;
    for (int axis = 0; axis < 3; ++axis)
    {
      const bool upper = (corner >> axis & 1) != 0;
      weight *= upper ? fraction[axis] : 1.0 - fraction[axis];
      voxel[axis] += upper ? 1 : 0;
    }
    const Density density = at(voxel.x(), voxel.y(), voxel.z());
    sum.tissue += weight * density.tissue;
    sum.bone += weight * density.bone;
  }
  return sum;
}

}  // namespace endovascular_sim::patient
