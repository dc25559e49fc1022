#pragma once

#include <algorithm>
#include <functional>

#include "patient/volume/density_volume.h"

namespace endovascular_sim::patient
{

/** Cubic lattice centred at a point. */
inline image::VolumeGrid cubicGrid(int side, double spacing, const Eigen::Vector3d& centre = Eigen::Vector3d::Zero())
{
  image::VolumeGrid grid;
  grid.size.setConstant(side);
  grid.spacing.setConstant(spacing);
  grid.origin = centre - 0.5 * (side - 1) * grid.spacing;
  return grid;
}

/** Fills a shape, given by its signed distance [m], with a density. The mean over each voxel is approximated by a
 * linear edge of one voxel's width. */
inline void fillShape(DensityVolume& volume, const Density& density,
                      const std::function<double(const Eigen::Vector3d&)>& distance)
{
  const image::VolumeGrid grid = volume.grid();
  for (int z = 0; z < grid.size.z(); ++z)
    for (int y = 0; y < grid.size.y(); ++y)
      for (int x = 0; x < grid.size.x(); ++x)
      {
        const double d = distance(grid.position(Eigen::Vector3d(x, y, z)));
        const double share = std::clamp(0.5 - d / grid.spacing.x(), 0.0, 1.0);
        volume.set(x, y, z, {share * density.tissue, share * density.bone});
      }
}

}  // namespace endovascular_sim::patient
