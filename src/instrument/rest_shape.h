#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "rod/model/wire.h"

namespace endovascular_sim::instrument
{

/** A point of a wire that nothing touches. */
struct RestPoint
{
  double arc_length = 0.0;  ///< from the hand's end [m]
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d tangent = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d d1 = Eigen::Vector3d::UnitX();  ///< material direction
  std::size_t section = 0;                        ///< that ends here or holds the point
};

/** Shape of a free wire: an arc for every section, joined with equal tangent and material frame (the Frenet–Serret
 *  integral of piecewise constant curvature, exact at every point). The hand's end lies in the origin, the wire leaves
 *  it along z, d1 along x.
 *  @param spacing largest distance of two points [m]; every end of a section is a point
 *  @return points in order, their lengths in metres */
std::vector<RestPoint> restShape(const rod::Wire& wire, double spacing);

}  // namespace endovascular_sim::instrument
