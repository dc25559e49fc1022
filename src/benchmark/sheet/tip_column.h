#pragma once

#include "rod/model/wire.h"

namespace endovascular_sim::benchmark
{

/** Euler load of the distal part of a wire, clamped at its proximal and pinned at its distal end, with the bending
 *  stiffness of its sections and without rest curvature [N]: the least P with a solution of EI y″ + P y = V (ℓ − s),
 *  y(0) = y′(0) = y(ℓ) = 0. 20.19 EI/ℓ² for a uniform wire.
 *  @param length ℓ of the part [m] */
double columnLoad(const rod::Wire& wire, double length);

/** Force across a cantilever, the distal part of a wire, that moves its tip by a distance across its axis [N]: the
 *  exact elastica EI θ′ = F (x(ℓ) − x) by shooting, without rest curvature. 3 EI δ/ℓ³ for a small δ.
 *  @param length ℓ of the part [m]
 *  @param deflection δ of the tip, less than ℓ/2 [m] */
double cantileverForce(const rod::Wire& wire, double length, double deflection);

/** Bending stiffness at a distance from the tip [N·m²]. */
double stiffnessFromTip(const rod::Wire& wire, double from_tip);

}  // namespace endovascular_sim::benchmark
