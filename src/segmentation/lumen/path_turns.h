#pragma once

#include <vector>

#include "segmentation/lumen/section.h"

namespace endovascular_sim::segmentation
{

/** Radius of a bend from which a path turns rather than follows a vessel, in radii of the lumen. */
constexpr double kTightestBend = 1.0;

/** Length at the ends of a branch in which it may turn into the lumen of another one, in diameters. */
constexpr double kEnds = 2.0;

/** Stretch of a branch. */
struct Stretch
{
  double from = 0.0;  ///< arc length from the begin of the branch [m]
  double to = 0.0;    ///< [m]
};

/** Stretches at which the centreline of a branch turns within kTightestBend, apart from the ends. */
std::vector<Stretch> turnsOf(const LumenBranch& branch);

}  // namespace endovascular_sim::segmentation
