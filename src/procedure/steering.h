#pragma once

#include <Eigen/Core>

namespace endovascular_sim::procedure
{

/** Observable bend of an instrument's tip. */
struct TipBend
{
  double length = 0.0;                              ///< length of the bent tip; 0 for a straight instrument [m]
  Eigen::Vector3d base = Eigen::Vector3d::Zero();   ///< proximal end of the bent tip, patient frame [m]
  Eigen::Vector3d shaft = Eigen::Vector3d::Zero();  ///< unit tangent of the shaft at the base, in distal direction
};

/** Rotation about the shaft that turns the bend of a tip towards a target [rad], in (−π, π]; right-handed about
 *  TipBend::shaft. 0 if the tip or the target lies within 10° of the shaft's axis.
 *  @param tip position of the tip [m]
 *  @param target position of the target [m] */
double turnTowards(const TipBend& bend, const Eigen::Vector3d& tip, const Eigen::Vector3d& target);

}  // namespace endovascular_sim::procedure
