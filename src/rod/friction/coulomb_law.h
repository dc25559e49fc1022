#pragma once

#include <algorithm>

namespace endovascular_sim::rod
{

/** Coulomb's law of friction with pre-sliding, of the length u of a stretch: the distance that a surface was dragged
 *  without sliding [m].
 *
 *  Up to δ the surface sticks and friction is proportional to the stretch; beyond, it slides and friction is constant.
 *  The potential is F u²/(2δ) up to δ and F (u − δ/2) beyond: convex, with a continuous first derivative. */
struct CoulombLaw
{
  double limit = 0.0;  ///< F = μ f_n [N]
  double slip = 1.0;   ///< δ, the stretch at which sliding begins [m]

  double potential(double length) const  ///< [J]
  {
    return length > slip ? limit * (length - 0.5 * slip) : limit * length * length / (2.0 * slip);
  }
  /** First derivative of the potential; odd in the stretch [N]. */
  double force(double stretch) const { return limit * stretch / std::max(std::max(stretch, -stretch), slip); }
  /** Force by length: a parabola with this curvature touches the potential and lies above it everywhere [N/m]. */
  double secant(double length) const { return limit / std::max(length, slip); }
  /** Second derivative of the potential; at δ that of the stiffer side [N/m]. */
  double tangent(double length) const { return length > slip ? 0.0 : limit / slip; }

  /** Return mapping: cuts a stretch to δ. */
  double returned(double stretch) const { return std::max(-slip, std::min(slip, stretch)); }
  /** The same of a vector. */
  template <typename Vector>
  void cut(Vector& stretch) const
  {
    const double length = stretch.norm();
    if (length > slip)
      stretch *= slip / length;
  }
};

}  // namespace endovascular_sim::rod
