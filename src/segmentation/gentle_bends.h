#pragma once

#include "vessel/centreline/centreline.h"

namespace endovascular_sim::segmentation
{

/** Least ratio of the radius of curvature to the least one that an anatomy permits (vessel::kTightestBend radii of the
 * lumen), along the spline through the points of a branch; an anatomy needs 1. */
double bendRatio(const vessel::CentrelineBranch& branch);

/** Makes the bends of a branch gentle enough for an anatomy. Its points are smoothed where it bends too tightly, and
 * their radii reduced by the shift, as those of inscribed circles; where that does not suffice, the radii are reduced
 * further. The ends stay, gentle branches are not changed. */
void makeBendsGentle(vessel::CentrelineBranch& branch);

}  // namespace endovascular_sim::segmentation
