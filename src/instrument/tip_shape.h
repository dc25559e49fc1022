#pragma once

#include <Eigen/Core>

#include "instrument/instrument.h"

namespace endovascular_sim::instrument
{

/** A plane bend at the end of a wire: an arc, and a straight leg from the arc to the tip. */
struct TipShape
{
  double radius = 0.0;     ///< of the arc [m]
  double angle = 0.0;      ///< that the arc turns [rad]
  double straight = 0.0;   ///< length of the leg beyond the arc [m]
  double direction = 0.0;  ///< axis about which the arc turns, from d1 towards d2 [rad]

  /** Arc and leg [m]. */
  double length() const { return radius * angle + straight; }
};

/** Rest curvature of an arc as a 2-vector in the material frame, ω̄ = (κb·d2, −κb·d1), for the curvature vector
 *  κb = (cos φ d1 + sin φ d2) / radius [1/m].
 *  @param radius of the arc [m]
 *  @param direction φ [rad]; at 0 the wire turns about d1 */
Eigen::Vector2d arcCurvature(double radius, double direction);

/** Bends the end of a wire: sections are cut where arc and leg begin.
 *  @throws std::invalid_argument when the shape is longer than the wire, or a bent stretch already has rest curvature
 */
void applyTipShape(Instrument& instrument, const TipShape& shape);

}  // namespace endovascular_sim::instrument
