#pragma once

#include <Eigen/Core>

namespace endovascular_sim::motion
{

/** Fade of the motion: weight 1 within a ball around the heart, 0 outside of a larger concentric ball.
 *
 *  w = 1 − t³(10 − 15t + 6t²) with t = (|X − c|² − core²)/(reach² − core²), limited to [0, 1]. The weight is C² in
 * space, and needs no square root. */
struct Fade
{
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]
  double core = 0.0;                                 ///< radius within which the weight is 1 [m]
  double reach = 0.0;                                ///< radius beyond which the weight is 0 [m]

  double width() const { return reach - core; }  ///< [m]
};

/** Long axis of the heart and fade of its motion, at rest (end-diastole, end-expiration). */
struct HeartFrame
{
  Eigen::Vector3d base = Eigen::Vector3d::Zero();   ///< on the axis, at the ostia of the coronary arteries [m]
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit vector from the base to the apex
  double length = 0.0;                              ///< from the base to the apex [m]
  Fade fade;

  Eigen::Vector3d apex() const { return base + length * axis; }  ///< [m]
};

/** Motion of the heart before its fade: v(p) = shift + linear p + twist (a·p) (a × p), with p = X − base and the axis
 * a. The same numbers describe velocities. */
struct MotionField
{
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();   ///< [m]
  Eigen::Matrix3d linear = Eigen::Matrix3d::Zero();  ///< [1]
  double twist = 0.0;                                ///< rotation about the axis per length of it [rad/m]

  MotionField operator+(const MotionField& other) const
  {
    return {shift + other.shift, linear + other.linear, twist + other.twist};
  }
  MotionField operator-(const MotionField& other) const
  {
    return {shift - other.shift, linear - other.linear, twist - other.twist};
  }
  MotionField operator*(double factor) const { return {factor * shift, factor * linear, factor * twist}; }

  bool isZero() const { return twist == 0.0 && (shift.array() == 0.0).all() && (linear.array() == 0.0).all(); }
};

}  // namespace endovascular_sim::motion
