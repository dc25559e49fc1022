#pragma once

#include <vector>

#include <Eigen/Core>

#include "segmentation/lumen/scan.h"
#include "segmentation/lumen/section.h"

namespace endovascular_sim::segmentation
{

/** Properties of images and walls that the edge of the lumen depends on. */
struct EdgeSettings
{
  double point_spread = 3e-4;  ///< standard deviation of the scanner's point spread [m]
  double wall = 8e-4;          ///< thickness of the vessel wall [m]; 0: no wall between lumen and surrounding
  double wall_value = 60.0;    ///< value of the wall
  double calcium = 900.0;      ///< value of calcium; 0: no calcium is looked for
  bool half_maximum = false;   ///< edges half-way between lumen and wall, for comparison
};

/** Settings for a modality: Hounsfield units of a CT, or no unit at all. */
EdgeSettings edgeSettings(image::Modality modality, const Eigen::Vector3d& spacing);

/** Fits cross-sections along a path.
 *
 *  The path is resampled, smoothed and moved onto the centres of its cross-sections, six times. A section has 48 rays
 * in a rotation-minimising frame. The edge of a ray is the first point that is as dark as the model of a blurred vessel
 *  predicts for the edge (EdgeModel), or, before calcium, half-way to the calcium. The standard deviation of the model
 *  contains point spread, voxel (h²/12) and linear interpolation (h²/6). The value of the lumen is a running median
 * along the branch. Medians over ±2 sections and ±2 rays and four Fourier harmonics smooth the contours; rays without
 * an edge, for instance into a side branch, are filled by the same medians.
 *  @param path polyline through the lumen, grid frame [m]
 *  @param largest_radius length of the rays [m]
 *  @return two or more sections */
std::vector<Section> fitLumen(const Scan& scan, const std::vector<Eigen::Vector3d>& path, double largest_radius,
                              const EdgeSettings& settings);

/** Polyline with points at equal distances; the first and last point stay. */
std::vector<Eigen::Vector3d> resample(const std::vector<Eigen::Vector3d>& path, double step);

}  // namespace endovascular_sim::segmentation
