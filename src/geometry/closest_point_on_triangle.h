#pragma once

#include <Eigen/Core>

namespace endovascular_sim::geometry
{

/** Closest point of a triangle with the feature (face, edge or vertex) that contains it. */
struct TrianglePoint
{
  Eigen::Vector3d point;  ///< closest point [m]
  int edge = -1;          ///< 0..2 if the point lies inside the edge from corner `edge` to the next corner, else −1
  int vertex = -1;        ///< 0..2 if the point is that corner, else −1
};

/** Closest point of triangle abc to p by Voronoi regions. C. Ericson, "Real-Time Collision Detection", 2005, §5.1.5. */
TrianglePoint closestPointOnTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                     const Eigen::Vector3d& c);

}  // namespace endovascular_sim::geometry
