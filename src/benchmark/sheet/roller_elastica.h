#pragma once

namespace endovascular_sim::benchmark
{

/** Three-point bending on frictionless rollers: an inextensible, unshearable wire of uniform stiffness. */
struct ThreePointBend
{
  double span = 0.04;               ///< L, between the axes of the supports [m]
  double bending_stiffness = 1e-4;  ///< EI [N·m²]
  double reach = 0.0;               ///< ρ, radius of a support plus that of the wire [m]
};

/** Force of the loading roller by beam theory at small deflection, 48 EI δ/L³ [N].
 *  @param deflection δ of the middle of the wire [m] */
double beamForce(const ThreePointBend& bend, double deflection);

/** Force of the loading roller by the exact elastica [N].
 *
 *  The support's force N is normal to the wire, at the slope θ_s of the contact: ½ EI θ′² = N sin(θ_s − θ), and
 *  F = 2 N cos θ_s. The contact moves inwards by ρ sin θ_s and down by ρ (1 − cos θ_s). Quadrature over θ, and
 * bisection over θ_s.
 *  @param deflection δ of the middle of the wire, up to 0.3 L [m]
 *  @throws std::invalid_argument for a deflection out of this range */
double elasticaForce(const ThreePointBend& bend, double deflection);

}  // namespace endovascular_sim::benchmark
