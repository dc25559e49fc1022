#pragma once

#include <cmath>
#include <string>

namespace endovascular_sim::benchmark
{

/** Propagation factor growth·exp(±i·angle) of the first mode of a clamped wire per step. */
struct Propagation
{
  double growth = NAN;   ///< modulus of the factor
  double angle = NAN;    ///< argument of the factor [rad]
  double step_us = 0.0;  ///< median time of a step [µs]
};

/** Vibration of a wire with a small amplitude; fits q(k+1) = a q(k) − b q(k−1) to the tip.
 *  @param turn phase of the first mode per step, ωΔt, with ω of the beam [rad] */
Propagation swing(const std::string& scheme, int nodes, double turn);

}  // namespace endovascular_sim::benchmark
