#pragma once

#include <vector>

#include "vessel/centreline/medial_spheres.h"

namespace endovascular_sim::vessel
{

/** Branch of the skeleton between two ends or forks, as indices of spheres. */
struct SkeletonBranch
{
  int parent = -1;           ///< index of the parent branch, −1 at the root
  std::vector<int> spheres;  ///< from the parent's last sphere to the next fork or end
};

/** Tree of minimal paths through overlapping spheres, rooted at its widest end. Parents precede their children.
 *  @param spheres sorted by decreasing radius (thinSpheres)
 *  @param neighbours per sphere, the indices of adjacent spheres */
std::vector<SkeletonBranch> medialSkeleton(const std::vector<MedialSphere>& spheres,
                                           const std::vector<std::vector<int>>& neighbours);

}  // namespace endovascular_sim::vessel
