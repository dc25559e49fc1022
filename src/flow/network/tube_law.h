#pragma once

#include <algorithm>
#include <cmath>

namespace endovascular_sim::flow
{

/** Cross-section of an elastic vessel at a pressure: P − P₀ = β(√(A/A₀) − 1), β = (4/3)Eh/r₀, of a thin wall with
 *  Poisson's ratio ½ (Olufsen 1999, eq. 2.21).
 *
 *  A collapsed vessel, √(A/A₀) < kCollapse, resists like A^(−3/2) (Shapiro 1977), with equal value and slope where both
 *  laws meet. So the area is positive at every pressure, and a convex function of it. */
struct TubeLaw
{
  static constexpr double kCollapse = 0.25;

  double area = 0.0;       ///< A₀, at the reference pressure [m²]
  double stiffness = 0.0;  ///< β [Pa]

  /** @param excess pressure above the reference pressure [Pa]
   *  @return A [m²] */
  double areaAt(double excess) const
  {
    const double root = 1.0 + excess / stiffness;
    if (root >= kCollapse)
      return area * root * root;
    const double root_of_ratio = std::cbrt(1.0 + 3.0 * (kCollapse - root) / kCollapse);
    return area * kCollapse * kCollapse / (root_of_ratio * root_of_ratio);
  }

  /** dA/dP [m²/Pa]. @param excess as for areaAt() */
  double complianceAt(double excess) const
  {
    const double root = 1.0 + excess / stiffness;
    if (root >= kCollapse)
      return 2.0 * area * root / stiffness;
    const double ratio = 1.0 + 3.0 * (kCollapse - root) / kCollapse;
    const double root_of_ratio = std::cbrt(ratio);
    return 2.0 * area * kCollapse / (stiffness * ratio * root_of_ratio * root_of_ratio);
  }

  /** Wave speed √(A/(ρ dA/dP)) [m/s]. @param density ρ [kg/m³] */
  double waveSpeed(double excess, double density) const
  {
    return std::sqrt(areaAt(excess) / (density * complianceAt(excess)));
  }
};

}  // namespace endovascular_sim::flow
