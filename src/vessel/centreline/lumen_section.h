#pragma once

#include <vector>

#include <Eigen/Core>

#include "geometry/mesh_distance.h"

namespace endovascular_sim::vessel
{

constexpr int kSectionRays = 64;  ///< usual number of rays of a cross-section
constexpr double kNoHit = 1e300;  ///< length of a ray that leaves the lumen

/** Equal-area diameter of a cross-section of the lumen [m]. Rays that enter a side branch (longer than 1.5 times the
 *  median, or without a hit) are replaced by the median.
 *  @param reaches lengths of rays from a point inside to the wall, at equal angles; three or more; kNoHit without a
 *         hit [m] */
double equalAreaDiameter(const std::vector<double>& reaches);

/** Equal-area diameter of a cross-section of the lumen [m], from rays in the plane of the section. The first ray has
 *  the direction axis.unitOrthogonal(), the others follow it counter-clockwise about the axis.
 *  @param centre point of the section inside the lumen [m]
 *  @param axis unit normal of the section
 *  @param rays number of rays, three or more */
double lumenDiameter(const geometry::MeshDistance& wall, const Eigen::Vector3d& centre, const Eigen::Vector3d& axis,
                     int rays = kSectionRays);

}  // namespace endovascular_sim::vessel
