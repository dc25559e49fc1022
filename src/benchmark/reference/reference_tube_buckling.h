#pragma once

#include <string>

#include "benchmark/reference/reference_wire.h"

namespace endovascular_sim::benchmark
{

/** Axial force of a heavy wire that lies in a straight horizontal tube, pinned at both ends on the tube's bottom, just
 *  buckled to its sides, over √(EI q/r); length 10 (EI r/q)^¼, three half waves.
 *
 *  The ends are held as far apart as a small sine leaves them; the wire then finds its own shape. */
constexpr double kTubeBuckling = 2.0140553254573508;
Measured buckleInATube(const std::string& scheme, int nodes);

/** The same without weight in a tube with its axis bent to a radius R, clamped at both ends on the bend's outer side:
 *  force over 4 EI/(r R) for r/R = 1/200 and 12.7 half waves. */
Measured buckleInABentTube(const std::string& scheme, int nodes);

}  // namespace endovascular_sim::benchmark
