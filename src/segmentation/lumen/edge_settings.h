#pragma once

#include <Eigen/Core>

#include "image/volume.h"

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

/** Standard deviation of the blur across a direction: scanner, voxel (h²/12) and linear interpolation (h²/6) [m].
 *  @param tangent unit vector along the vessel */
double blurAcross(const EdgeSettings& settings, const Eigen::Vector3d& spacing, const Eigen::Vector3d& tangent);

}  // namespace endovascular_sim::segmentation
