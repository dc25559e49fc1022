#pragma once

#include <Eigen/Core>

namespace endovascular_sim::geometry
{

/** Which part of a triangle is closest. */
struct TrianglePoint
{
  Eigen::Vector3d point;  ///< on the triangle [m]
  int edge = -1;          ///< 0..2: the point lies on the edge from corner `edge` to the next one
  int vertex = -1;        ///< 0..2: the point is that corner
};

/** Closest point of triangle abc to p (Ericson 2005, §5.1.5), with the feature it lies on. */
TrianglePoint closestPointOnTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                     const Eigen::Vector3d& c);

}  // namespace endovascular_sim::geometry
