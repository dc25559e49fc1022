#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "segmentation/lumen/section.h"

namespace endovascular_sim::segmentation
{

/** Share of a circumference that may lack an edge: over a longer stretch than kOpenLength, the contour is unknown. */
constexpr double kOpenShare = 0.2;
constexpr double kOpenLength = 3e-3;  ///< [m]

/** Stretch of a branch whose contour is unknown. */
struct OpenStretch
{
  std::size_t first = 0;  ///< section
  std::size_t last = 0;   ///< section, included
  double share = 0.0;     ///< largest share of the circumference without an edge
};

/** True at a point in the lumen of another branch. */
using OtherLumen = std::function<bool(const Eigen::Vector3d& point)>;

/** True if a ray beyond the contour lies in another lumen somewhere. */
bool runsThroughOther(const Section& section, int ray, const OtherLumen& other);

/** Share of the rays of a section that have no edge of their own, and do not run through another lumen.
 *  @param other empty: there is none
 *  @param dropped counts also edges that do not fit those of the neighbours */
double openShare(const Section& section, const OtherLumen& other, bool dropped = false);

/** Stretches in which more than a share of the circumference has no edge, in the mean over kOpenLength. A stretch at an
 *  end of the branch does not count up to the length of two diameters and 10 mm: the end may lie in a wider lumen. */
std::vector<OpenStretch> openStretches(const std::vector<Section>& sections, const OtherLumen& other,
                                       bool dropped = false, double most = kOpenShare);

}  // namespace endovascular_sim::segmentation
