#pragma once

#include <string>

#include "benchmark/reference/reference_wire.h"

namespace endovascular_sim::benchmark
{

/** Exact force of buckleInATube(). */
constexpr double kTubeBuckling = 2.0140553254573508;

/** Axial force of a heavy wire on the bottom of a straight horizontal tube at the onset of lateral buckling, over
 *  √(EI q/r). Both ends are pinned; the length is 10 (EI r/q)^¼, the mode has three half waves.
 *
 *  The distance of the ends corresponds to a sine of small amplitude; the wire takes its own shape. */
Measured buckleInATube(const std::string& scheme, int nodes);

/** Axial buckling force of a weightless wire in a tube bent to a radius R, clamped at both ends on the outer side of
 * the bend, over 4 EI/(r R); r/R = 1/200 and 12.7 half waves. */
Measured buckleInABentTube(const std::string& scheme, int nodes);

}  // namespace endovascular_sim::benchmark
