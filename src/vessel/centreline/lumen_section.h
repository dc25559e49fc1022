#pragma once

#include <Eigen/Core>

#include "geometry/mesh_distance.h"

namespace endovascular_sim::vessel
{

/** Equal-area diameter of a cross-section of the lumen [m], from rays in the plane of the section. Rays that enter a
 *  side branch (longer than 1.5 times the median, or without a hit) are replaced by the median.
 *  @param centre point of the section inside the lumen [m]
 *  @param axis unit normal of the section
 *  @param rays number of rays, three or more */
double lumenDiameter(const geometry::MeshDistance& wall, const Eigen::Vector3d& centre, const Eigen::Vector3d& axis,
                     int rays = 64);

}  // namespace endovascular_sim::vessel
