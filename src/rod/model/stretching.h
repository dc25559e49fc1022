#pragma once

#include <algorithm>

#include <Eigen/Core>

namespace endovascular_sim::rod
{

/** Stretch energy of one edge, E = ½ EA (|e|/ē − 1)² ē: value, gradient and Hessian by the edge e. */
struct Stretching
{
  Eigen::Vector3d direction;  ///< e/|e|
  double length;              ///< |e| [m]
  double rest_length;         ///< ē [m]
  double axial_stiffness;     ///< EA [N]
  double tension;             ///< EA (|e|/ē − 1) [N]

  Stretching(const Eigen::Vector3d& edge, double rest, double stiffness)
    : direction(edge.normalized()),
      length(edge.norm()),
      rest_length(rest),
      axial_stiffness(stiffness),
      tension(stiffness * (length / rest - 1.0))
  {
  }

  /** Energy [J]. */
  double energy() const { return 0.5 * tension * (length - rest_length); }

  /** ∂E/∂e: the tension along the edge [N]. */
  Eigen::Vector3d gradient() const { return tension * direction; }

  /** Positive semi-definite part of ∂²E/∂e²: without the geometric term of compression [N/m]. */
  Eigen::Matrix3d positiveHessian() const
  {
    return (axial_stiffness / rest_length) * direction * direction.transpose() + geometric(std::max(0.0, tension));
  }

  /** Second derivative of λ(|e| − ē) with the multiplier λ of an inextensible edge: λ/|e| (I − ttᵀ) [N/m]. */
  Eigen::Matrix3d geometric(double multiplier) const
  {
    return (multiplier / length) * (Eigen::Matrix3d::Identity() - direction * direction.transpose());
  }
};

}  // namespace endovascular_sim::rod
