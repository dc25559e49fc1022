#pragma once

#include <Eigen/Core>

#include "instrument/instrument.h"

namespace endovascular_sim::instrument
{

/** Planar tip shape of a wire: an arc followed by a straight distal leg. */
struct TipShape
{
  double radius = 0.0;     ///< radius of the arc [m]
  double angle = 0.0;      ///< angle that the arc subtends [rad]
  double straight = 0.0;   ///< length of the straight leg [m]
  double direction = 0.0;  ///< direction of the bending axis, from d1 towards d2 [rad]

  /** Length of arc and leg [m]. */
  double length() const { return radius * angle + straight; }
};

/** Rest curvature of an arc as a 2-vector in the material frame, ω̄ = (κb·d2, −κb·d1), for the curvature vector
 *  κb = (cos φ d1 + sin φ d2) / radius [1/m].
 *  @param radius radius of the arc [m]
 *  @param direction direction φ of the bending axis [rad]; 0 bends about d1 */
Eigen::Vector2d arcCurvature(double radius, double direction);

/** Applies a tip shape to the distal end of a wire. Sections are split at the beginning of arc and leg.
 *  @throws std::invalid_argument if the shape is longer than the wire, or a section within it has rest curvature */
void applyTipShape(Instrument& instrument, const TipShape& shape);

}  // namespace endovascular_sim::instrument
