#pragma once

#include <vector>

#include "vessel/centreline/medial_spheres.h"

namespace endovascular_sim::vessel
{

/** A piece of the skeleton between two ends or forks, as indices of balls. */
struct SkeletonBranch
{
  int parent = -1;         ///< index of the parent branch
  std::vector<int> balls;  ///< from the parent's last ball to the next fork or the end
};

/** Tree of minimal paths through overlapping balls, rooted at its widest end; parents stand before their children.
 *  @param balls largest first (thinBalls) */
std::vector<SkeletonBranch> ballSkeleton(const std::vector<MedialSphere>& balls,
                                         const std::vector<std::vector<int>>& neighbours);

}  // namespace endovascular_sim::vessel
