#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "segmentation/lumen/scan.h"
#include "segmentation/lumen/wide_regions.h"

namespace endovascular_sim::segmentation
{

/** Brightness of the lumen between two clicks. */
struct LumenRange
{
  double low = 0.0;         ///< darker end
  double high = 0.0;        ///< brighter end
  double background = 0.0;  ///< tissue around the lumen

  /** Standard deviation of the speed's Gaussian, and of the lumen in its widest sense. */
  double width() const { return 0.22 * (low - background); }

  /** Half-way between background and lumen. */
  double threshold() const { return low - 2.2 * width(); }
};

/** Length of a polyline [m]. */
inline double lengthOf(const std::vector<Eigen::Vector3d>& points)
{
  double length = 0.0;
  for (std::size_t k = 0; k + 1 < points.size(); ++k)
    length += (points[k + 1] - points[k]).norm();
  return length;
}

/** Path between two points of an image. */
struct MinimalPath
{
  std::vector<Eigen::Vector3d> points;                     ///< grid frame, from the first point to the last [m]
  double longest_gap = 0.0;                                ///< longest stretch outside of the lumen [m]
  Eigen::Vector3d gap_location = Eigen::Vector3d::Zero();  ///< middle of that stretch [m]

  /** Length of the path [m]. */
  double length() const { return lengthOf(points); }

  /** True if the path leaves the lumen for more than 2 mm: its ends lie in two vessels. */
  bool leavesLumen() const { return longest_gap > 2e-3; }
};

/** Value below which no voxel is closed. */
constexpr double kNoLeastValue = -1e30;

/** Path of least travel time through the lumen, over the 26 neighbours of voxels (Dijkstra's algorithm with the
 * straight distance as bound). Speed: exp(−½ z²), z the deviation from the range in widths, not below 0.004; in wide
 * regions not above 0.006. Values above the range slow the path in CT only, where they are calcium. The whole image is
 * open to the path; memory is used only where it searches.
 *  @param from, to points of the grid frame inside the image [m]
 *  @param least closes darker voxels
 *  @return no points if all ways are closed */
MinimalPath minimalPath(const Scan& scan, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                        const LumenRange& range, const WideRegions& wide, double least = kNoLeastValue);

}  // namespace endovascular_sim::segmentation
