#include "image/volume_grid.h"

#include <cmath>
#include <string>

#include "common/error.h"

namespace endovascular_sim::image
{
namespace
{

constexpr double kLeastSpacing = 1e-6;  // m
constexpr double kMostSpacing = 0.05;   // m
constexpr double kFarthest = 10.0;      // m from the origin of the patient frame
constexpr int kMostVoxels = 8192;       // along one axis
constexpr double kOrthogonal = 1e-3;    // error of the scalar products of the axes

}  // namespace

std::size_t VolumeGrid::voxels() const
{
  return static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(size.z());
}

Eigen::Vector3d VolumeGrid::position(const Eigen::Vector3d& index) const
{
  return origin + axes * index.cwiseProduct(spacing);
}

Eigen::AlignedBox3d VolumeGrid::bounds() const
{
  Eigen::AlignedBox3d box;
  const Eigen::Vector3d last = (size.array() - 1).cast<double>();
  for (int corner = 0; corner < 8; ++corner)
    box.extend(position(Eigen::Vector3d((corner & 1) != 0 ? last.x() : 0.0, (corner & 2) != 0 ? last.y() : 0.0,
                                        (corner & 4) != 0 ? last.z() : 0.0)));
  return box;
}

void requireValid(const VolumeGrid& grid, const std::string& file)
{
  for (int k = 0; k < 3; ++k)
  {
    const std::string axis = "axis " + std::to_string(k + 1);
    if (grid.size[k] < 2 || grid.size[k] > kMostVoxels)
      throw InputError(file, axis,
                       "has " + std::to_string(grid.size[k]) + " voxels; a volume has 2 to 8192 along each axis");
    if (!(grid.spacing[k] >= kLeastSpacing && grid.spacing[k] <= kMostSpacing))
      throw InputError(file, axis,
                       "its spacing is " + std::to_string(1e3 * grid.spacing[k]) + " mm; must be 0.001 to 50 mm");
    if (!(std::abs(grid.origin[k]) <= kFarthest))
      throw InputError(
          file, "origin",
          "lies " + std::to_string(grid.origin[k]) + " m from that of the patient frame; must be within 10 m");
  }
  const Eigen::Matrix3d error = grid.axes.transpose() * grid.axes - Eigen::Matrix3d::Identity();
  if (!(error.cwiseAbs().maxCoeff() <= kOrthogonal))
    throw InputError(file, "axes", "are not orthogonal; export the volume without shear or gantry tilt");
}

}  // namespace endovascular_sim::image
