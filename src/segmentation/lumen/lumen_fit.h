#pragma once

#include <vector>

#include <Eigen/Core>

#include "segmentation/lumen/edge_settings.h"
#include "segmentation/lumen/scan.h"
#include "segmentation/lumen/section.h"

namespace endovascular_sim::segmentation
{

/** Length of rays along a path. */
class RayReach
{
public:
  /** @param length of the rays [m] */
  explicit RayReach(double length) : length_(length) {}

  /** Reach of the sections of an earlier fit. */
  RayReach(double length, const std::vector<Section>& sections);

  double length() const { return length_; }

  /** Length of the rays at a point of a path: that of the nearest section [m]. */
  double at(const Eigen::Vector3d& p) const;

private:
  double length_;
  std::vector<Eigen::Vector3d> points_;  ///< empty: equal everywhere
  std::vector<double> reach_;
};

/** Fits cross-sections along a path.
 *
 *  The path is resampled, smoothed and moved onto the centres of its cross-sections, six times. A section has 48 rays
 * in a rotation-minimising frame. RayEdges finds the edges, setContours() (contour_filter.h) smooths them to contours.
 *  @param path polyline through the lumen, grid frame [m]
 *  @param reach length of the rays
 *  @return two or more sections */
std::vector<Section> fitLumen(const Scan& scan, const std::vector<Eigen::Vector3d>& path, const RayReach& reach,
                              const EdgeSettings& settings);

/** Polyline with points at equal distances; the first and last point stay. */
std::vector<Eigen::Vector3d> resample(const std::vector<Eigen::Vector3d>& path, double step);

}  // namespace endovascular_sim::segmentation
