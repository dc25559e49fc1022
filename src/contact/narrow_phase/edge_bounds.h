#pragma once

#include <Eigen/Core>

namespace endovascular_sim::contact
{

/** A mesh edge and its smallest ball. */
struct EdgeBounds
{
  Eigen::Vector3d middle;
  Eigen::Vector3d normal;  ///< towards the lumen, ⟂ direction, unit
  Eigen::Vector3d half;    ///< from the middle to the edge's end
  double half_length;      ///< [m]
  double lean;             ///< no local minimum's offset is tilted more off the normal, as a tangent; infinite: any
  bool reflex;             ///< whether the wire's edges can meet it
};

}  // namespace endovascular_sim::contact
