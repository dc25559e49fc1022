#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "rod/model/wire.h"

namespace endovascular_sim::instrument
{

/** Point of the unloaded wire. */
struct RestPoint
{
  double arc_length = 0.0;                             ///< from the proximal end [m]
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d tangent = Eigen::Vector3d::UnitZ();  ///< unit
  Eigen::Vector3d d1 = Eigen::Vector3d::UnitX();       ///< first director of the material frame
  std::size_t section = 0;                             ///< index of the section that contains or ends at the point
};

/** Shape of the unloaded wire: one circular arc per section, joined with continuous tangent and material frame. This
 *  is the exact integral of the Frenet–Serret equations for piecewise constant curvature. The proximal end lies at the
 *  origin with its tangent along z and d1 along x.
 *  @param spacing largest arc length between two points [m]; the ends of every section are points
 *  @return points from proximal to distal */
std::vector<RestPoint> restShape(const rod::Wire& wire, double spacing);

}  // namespace endovascular_sim::instrument
