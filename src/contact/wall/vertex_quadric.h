#pragma once

#include <vector>

#include <Eigen/Core>

#include "contact/wall/wall.h"

namespace endovascular_sim::contact
{

/** Quadric through a vertex of the wall: the zeros of q(x) = n·d − ½ dᵀBd with d = x − vertex. The matrix B is the
 *  curvature tensor (positive where the wall is concave as seen from the lumen) plus a share along the normal that
 * makes the quadric of a cylinder or a sphere exact. */
struct VertexQuadric
{
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< n, towards the lumen, unit
  Eigen::Matrix3d bend = Eigen::Matrix3d::Zero();    ///< B [1/m]

  /** q, the height over the quadric to first order. @param from vector from the vertex [m] */
  double height(const Eigen::Vector3d& from) const { return normal.dot(from) - 0.5 * from.dot(bend * from); }
  /** Gradient of q. */
  Eigen::Vector3d gradient(const Eigen::Vector3d& from) const { return normal - bend * from; }
};

/** Least-squares quadrics of all vertices through their neighbours (second-order jets, Cazals & Pouget 2005). */
std::vector<VertexQuadric> fitVertexQuadrics(const Wall& wall);

/** Disagreement of the quadrics around every vertex [rad]. At one end of an edge, it is the angle between the normal of
 *  that end's own quadric and the normal that the other end's quadric predicts there. The result is the mean over both
 *  ends of all edges of the vertex. It is 0 for spheres and cylinders of any resolution, and half the dihedral angle or
 *  more at a crease between flat parts. */
std::vector<double> quadricDisagreement(const Wall& wall, const std::vector<VertexQuadric>& quadrics);

}  // namespace endovascular_sim::contact
