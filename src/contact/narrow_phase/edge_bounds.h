#pragma once

#include <Eigen/Core>

#include "contact/wall/wall.h"

namespace endovascular_sim::contact
{

/** Bounds of a mesh edge: its smallest enclosing ball and its normal cone. */
struct EdgeBounds
{
  Eigen::Vector3d middle;
  Eigen::Vector3d normal;  ///< unit, towards the lumen, perpendicular to the edge
  Eigen::Vector3d half;    ///< vector from the middle to the edge's second end
  double half_length;      ///< [m]
  double cone_slope;       ///< bound of the offset's tangent to the normal at a local minimum; infinite: unbounded
  bool reflex;             ///< whether edges of the wire are tested against it
};

EdgeBounds makeEdgeBounds(const Wall& wall, const WallEdge& edge);

}  // namespace endovascular_sim::contact
