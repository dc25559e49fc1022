#pragma once

#include <array>
#include <vector>

#include "motion/map/motion_map.h"

namespace endovascular_sim::motion
{

/** Bounds of a map, or of several, over points of the resting patient. */
struct MapBounds
{
  double determinant = 1.0;        ///< least det ∇φ [1]; space is not folded where it is positive everywhere
  double gradient = 0.0;           ///< largest |∇u|, spectral norm [1]
  double least_stretch = 1.0;      ///< least singular value of ∇φ: length moved per length at rest [1]
  double largest_stretch = 1.0;    ///< largest singular value of ∇φ [1]
  double curvature = 0.0;          ///< bound of |∇²u| along any direction [1/m]
  double inverse_curvature = 0.0;  ///< bound of |∇²φ⁻¹| along any direction [1/m]
  double displacement = 0.0;       ///< largest |u| [m]
  double speed = 0.0;              ///< largest |∂u/∂t| [m/s]
  double round_trip = 0.0;         ///< largest |φ⁻¹(φ(X)) − X| [m]

  /** Includes the bounds of another map, or of other points. */
  void include(const MapBounds& other);
  /** Bound of the sag of an edge that is straight in the moved patient and pulled back [m]. @param edge length [m] */
  double sag(double edge) const { return edge * edge * inverse_curvature / 8.0; }
};

/** Bounds of a map at points. @param points at rest [m] */
MapBounds mapBounds(const MotionMap& map, const std::vector<Eigen::Vector3d>& points);

/** Points of a cubic grid within the fade. @param spacing [m] */
std::vector<Eigen::Vector3d> gridOf(const Fade& fade, double spacing);

/** Second derivatives of a vector field: one symmetric matrix for each component [1/m]. */
using SecondDerivatives = std::array<Eigen::Matrix3d, 3>;

/** Second derivatives of the displacement at a point. */
SecondDerivatives secondDerivatives(const MotionMap& map, const Eigen::Vector3d& rest);

/** Second derivatives of φ⁻¹ at φ(X): −∇φ⁻¹ ∇²u[∇φ⁻¹ ·, ∇φ⁻¹ ·].
 *  @param second those of the displacement at X
 *  @param inverse ∇φ⁻¹ */
SecondDerivatives inverseSecondDerivatives(const SecondDerivatives& second, const Eigen::Matrix3d& inverse);

}  // namespace endovascular_sim::motion
