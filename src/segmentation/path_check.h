#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "segmentation/lumen/click_check.h"

namespace endovascular_sim::segmentation
{

/** Path through the clicks of a branch. */
struct ClickPath
{
  std::vector<Eigen::Vector3d> points;  ///< grid frame [m]
  std::vector<std::size_t> clicks;      ///< index of the point of each click
};

/** Checks that a path leads from one end of a branch to the other.
 *  @param is_alone true for a vessel of one branch, which must be longer than one that continues others
 *  @param file of the clicks, in errors
 *  @throws InputError for a path that is shorter than the lumen is wide, and one that turns back at a click */
void requireCourse(const ClickPath& path, const CheckedBranch& branch, bool is_alone, const std::string& file);

}  // namespace endovascular_sim::segmentation
