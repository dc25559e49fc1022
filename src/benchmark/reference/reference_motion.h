#pragma once

#include <cmath>
#include <string>

namespace endovascular_sim::benchmark
{

/** What a step does to the first mode of a clamped wire: growth·exp(±i·angle). */
struct Propagation
{
  double growth = NAN;
  double angle = NAN;    ///< [rad]
  double step_us = 0.0;  ///< median time of a step [µs]
};

/** Lets the wire swing with a tiny amplitude and fits q(k+1) = a q(k) − b q(k−1) to the tip.
 *  @param turn of the first mode per step, ωΔt, ω that of the beam [rad] */
Propagation swing(const std::string& scheme, int nodes, double turn);

}  // namespace endovascular_sim::benchmark
