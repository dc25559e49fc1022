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
  double given_radius = 0.0;    ///< bound of the lumen's radius by the user [m]; 0: none
  double largest_radius = 0.0;  ///< bound of the lumen's radius along the branch [m]

  /** True if the user gives the bound of the radius. */
  bool isBounded() const { return given_radius > 0.0; }

  /** Brightness of the lumen between two successive clicks. */
  LumenRange range(std::size_t first) const;

  /** Brightness of the lumen at all clicks. */
  LumenRange wholeRange() const;

  /** Bound of the lumen's radius between two successive clicks: 1.6 times the wider one, 3 times the narrower one, or
   * that of the user [m]. */
  double radiusBound(std::size_t first) const;
};

/** Checks that all clicks lie in a contrast-filled lumen, and measures it there.
 *  @param warnings receives unusual findings
 *  @throws InputError for a click outside of the image, or in air, bone, soft tissue or the wall; it names the file,
 * the branch and the click, the value there, and the nearest point in a lumen */
std::vector<CheckedBranch> checkClicks(const Scan& scan, const ClickSet& clicks, std::vector<std::string>& warnings);

}  // namespace endovascular_sim::segmentation
