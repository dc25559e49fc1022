#pragma once

#include <string>

#include "benchmark/reference/reference_wire.h"

namespace endovascular_sim::benchmark
{

/** Force of a frictionless channel's ceiling on the tip of a pre-curved wire that is clamped on its floor, F l²/EI.
 *  @param turn natural curvature times the wire's length l
 *  @param height of the channel over l */
Measured ceilingForce(const std::string& scheme, double turn, double height, int nodes);

/** Tension over slack tension, T2/T1, of a stiff wire drawn over a peg of radius R by 90°, friction 0.3,
 *  EI/(T1 R²) = 0.1.
 *  @param speed at which it is drawn [m/s] */
constexpr double kCapstanRatio = 1.5773414787761537;
Measured capstanRatio(const std::string& scheme, int nodes, double speed);

/** Mean forces at the hand over those of ½EIκ², frictionless, clearance a hundredth of the bend's radius. */
struct Insertion
{
  double filling = 0.0;  ///< over 10 mm of travel while the bend fills: 1
  double beyond = 0.0;   ///< over 10 mm after the tip has left it: 0
  double step_us = 0.0;
  std::string note;
};
Insertion insertIntoABend(const std::string& scheme, int nodes);

}  // namespace endovascular_sim::benchmark
