#pragma once

#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::geometry
{

/** Newell's normal of a polygon: twice the sum of the vector areas about its first corner [m²]. */
Eigen::Vector3d newellNormal(const std::vector<int>& ring, const std::vector<Eigen::Vector3d>& positions);

/** Triangulates a polygon by ear clipping in the plane of its Newell normal. A polygon without an ear is degenerate or
 *  intersects itself: its corners are cut off in their order. The cost is cubic in the number of corners at worst.
 *  @param ring indices of at least three corners
 *  @return triangles of indices, oriented like the polygon */
std::vector<Eigen::Vector3i> triangulatePolygon(std::vector<int> ring, const std::vector<Eigen::Vector3d>& positions);

}  // namespace endovascular_sim::geometry
