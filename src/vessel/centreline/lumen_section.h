#pragma once

#include <Eigen/Core>

#include "geometry/mesh_distance.h"

namespace endovascular_sim::vessel
{

/** Diameter of the circle that has the area of the lumen's section across an axis [m], from rays in that plane. Rays
 *  that leave through a side branch (longer than 1.5 times the median, or without a hit) count as the median.
 *  @param centre a point in the lumen [m]
 *  @param axis unit vector across the section
 *  @param rays three or more */
double lumenDiameter(const geometry::MeshDistance& wall, const Eigen::Vector3d& centre, const Eigen::Vector3d& axis,
                     int rays = 64);

}  // namespace endovascular_sim::vessel
