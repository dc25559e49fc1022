#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "segmentation/clicks/click_set.h"
#include "segmentation/lumen/minimal_path.h"
#include "segmentation/lumen/scan.h"

namespace endovascular_sim::segmentation
{

/** Lumen around a click. */
struct LumenAtClick
{
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< grid frame [m]
  double value = 0.0;                                  ///< of the lumen
  double radius = 0.0;                                 ///< of the lumen, estimated [m]
};

/** Clicks of a branch, checked. */
struct CheckedBranch
{
  std::string name;
  std::vector<LumenAtClick> clicks;
  double background = 0.0;      ///< value around the lumen
  double largest_radius = 0.0;  ///< [m]

  /** Brightness of the lumen between two successive clicks. */
  LumenRange range(std::size_t first) const;
};

/** Checks that all clicks lie in a contrast-filled lumen, and measures it there.
 *  @param warnings receives unusual findings
 *  @throws InputError for a click outside of the image, or in air, bone, soft tissue or the wall; it names the file,
 * the branch and the click, the value there, and the nearest point in a lumen */
std::vector<CheckedBranch> checkClicks(const Scan& scan, const ClickSet& clicks, std::vector<std::string>& warnings);

}  // namespace endovascular_sim::segmentation
