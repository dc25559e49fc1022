#pragma once

#include <string>

#include "benchmark/reference/reference_wire.h"

namespace endovascular_sim::benchmark
{

/** Force of the ceiling of a frictionless channel on the tip of a pre-curved wire clamped on its floor, F l²/EI.
 *  @param turn rest curvature times the length l of the wire
 *  @param height height of the channel over l */
Measured ceilingForce(const std::string& scheme, double turn, double height, int nodes);

/** Exact ratio of capstanRatio(). */
constexpr double kCapstanRatio = 1.5773414787761537;

/** Ratio T2/T1 of the tensions of a stiff wire drawn over a peg of radius R by 90°, friction 0.3, EI/(T1 R²) = 0.1.
 *  @param speed drawing speed [m/s] */
Measured capstanRatio(const std::string& scheme, int nodes, double speed);

/** Mean forces at the hand over ½EIκ² of a frictionless insertion; the clearance is a hundredth of the bend radius. */
struct Insertion
{
  double filling = 0.0;  ///< mean over 10 mm of travel while the tip is in the bend; exact: 1
  double beyond = 0.0;   ///< mean over 10 mm after the tip has left the bend; exact: 0
  double step_us = 0.0;  ///< median time of a step [µs]
  std::string note;      ///< irregularity of the run; empty: none
};

/** Inserts a straight wire into a bend of 90°. */
Insertion insertIntoABend(const std::string& scheme, int nodes);

}  // namespace endovascular_sim::benchmark
