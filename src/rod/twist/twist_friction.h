#pragma once

#include <cmath>

#include "rod/friction/coulomb_law.h"

namespace endovascular_sim::rod
{

/** Coulomb friction of the wall about the wire's axis on one node, for a given normal force and translation.
 *
 *  A rotation φ displaces the wire's surface over the wall by u(φ) = u₀ + φ p, where p is r times its direction: the
 *  component along p is `along` + φ·`arm`, the square of the one across is `across_squared`. The potential is that of
 *  CoulombLaw, convex in φ. */
struct TwistFriction
{
  int node = 0;
  double limit = 0.0;           ///< μ f_n [N]
  double slip = 0.0;            ///< δ [m]
  double arm = 0.0;             ///< |p| [m/rad]
  double along = 0.0;           ///< u₀·p/|p| [m]
  double across_squared = 0.0;  ///< |u₀|² − along² [m²]
  double begin_angle = 0.0;     ///< angle of the node at φ = 0 [rad]

  /** First derivative of the potential by φ: minus the torque on the wire [N·m]. */
  double pull(double turn) const { return secant(turn) * (along + turn * arm) / arm; }

  /** Second derivative by φ; at |u| = δ that of the stiffer side [N·m/rad]. */
  double stiffness(double turn) const
  {
    const double u = along + turn * arm;
    const double squared = u * u + across_squared;
    return squared > slip * slip ? secant(turn) * across_squared / squared : secant(turn);
  }

  /** Curvature of a parabola that touches the potential at φ and lies above it everywhere [N·m/rad]. */
  double secant(double turn) const
  {
    const double u = along + turn * arm;
    return CoulombLaw{limit * arm * arm, slip}.secant(std::sqrt(u * u + across_squared));
  }
};

}  // namespace endovascular_sim::rod
