#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "segmentation/lumen/minimal_path.h"
#include "segmentation/lumen/scan.h"

namespace endovascular_sim::segmentation
{

/** Place at which a path crosses a wall. */
struct WallCrossing
{
  Eigen::Vector3d location = Eigen::Vector3d::Zero();  ///< darkest point, grid frame [m]
  double bright = 0.0;  ///< value that all voxels of another way between its two sides exceed
};

/** Finds the first place at which a path crosses the wall between two lumens that touch, e.g. at the neck of a loop.
 *
 *  There the path is darker than on both sides by a fifth of the contrast or more. A stenosis is dark as well, but its
 *  lumen ends on both sides of the dark place. At a wall, one of two is true. Either both lumens pass by: they leave a
 *  ball of four lumen radii by two arms or more. Or they are connected in another way, e.g. round a loop: by voxels
 * that are brighter than the middle between the dark place and its sides. A path that cuts a bend of its own lumen
 * crosses no wall: it is connected within 1.5 lumen radii.
 *  @param path points in steps of a voxel, grid frame [m] */
std::optional<WallCrossing> wallCrossing(const Scan& scan, const std::vector<Eigen::Vector3d>& path,
                                         const LumenRange& range);

}  // namespace endovascular_sim::segmentation
