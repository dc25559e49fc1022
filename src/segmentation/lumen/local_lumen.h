#pragma once

#include <vector>

#include <Eigen/Core>

#include "segmentation/lumen/scan.h"

namespace endovascular_sim::segmentation
{

/** Value that a share of the values does not exceed.
 *  @param values are reordered */
double quantile(std::vector<double>& values, double share);

/** Values on a cube of points around a point of the grid frame.
 *  @param pitch distance of the points [m]
 *  @param steps points on each side of the middle */
std::vector<double> valuesAround(const Scan& scan, const Eigen::Vector3d& p, double pitch, int steps);

/** Value of the lumen at a point: 60 % quantile within 0.5 mm. */
double localValue(const Scan& scan, const Eigen::Vector3d& p);

/** Unit vectors that are spread evenly over a sphere, by the golden angle. */
std::vector<Eigen::Vector3d> directionsOfSphere(int count);

/** Radius of the lumen around a point: half of the shortest chord through it, at most 30 mm. Beside the axis the radius
 * is too small: by 6 % at 0.35 radii.
 *  @param p point of the grid frame [m]
 *  @param threshold value at the wall
 *  @return [m] */
double lumenRadius(const Scan& scan, const Eigen::Vector3d& p, double threshold);

}  // namespace endovascular_sim::segmentation
