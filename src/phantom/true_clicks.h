#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vessel/anatomy/anatomy.h"

namespace endovascular_sim::phantom
{

/** Clicks of an operator into one branch. */
struct BranchClicks
{
  std::string name;
  std::vector<Eigen::Vector3d> points;  ///< [m]
};

/** Simulated clicks: two per branch, near the ends of its part in the field of view. Each lies off the axis by 35 % of
 * the radius in a random direction.
 *  @param seed of the directions
 *  @param names of the branches, which may continue others; empty: all that have 15 mm or more in the field of view
 *         and belong to one tree there
 *  @param view field of view [m]
 *  @throws InputError for a name that the anatomy does not hold, or a branch outside of the field of view */
std::vector<BranchClicks> trueClicks(const vessel::Anatomy& anatomy, const std::vector<std::string>& names,
                                     const Eigen::AlignedBox3d& view, std::uint64_t seed);

}  // namespace endovascular_sim::phantom
