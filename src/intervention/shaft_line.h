#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::intervention
{

/** Centreline of an instrument's shaft, parametrised by the distance from its tip. */
class ShaftLine
{
public:
  /** @param from_tip distances of the points from the tip, monotonic, two or more [m]
   *  @param points positions [m] */
  ShaftLine(std::vector<double> from_tip, std::vector<Eigen::Vector3d> points)
    : from_tip_(std::move(from_tip)), points_(std::move(points))
  {
    if (from_tip_.front() <= from_tip_.back())
      return;
    std::reverse(from_tip_.begin(), from_tip_.end());
    std::reverse(points_.begin(), points_.end());
  }

  /** Position at a distance from the tip [m]; extrapolated linearly beyond the ends. */
  Eigen::Vector3d at(double from_tip) const
  {
    const auto next = std::upper_bound(from_tip_.begin() + 1, from_tip_.end() - 1, from_tip);
    const auto k = static_cast<std::size_t>(next - from_tip_.begin());
    const double t = (from_tip - from_tip_[k - 1]) / (from_tip_[k] - from_tip_[k - 1]);
    return points_[k - 1] + t * (points_[k] - points_[k - 1]);
  }

  double begin() const { return from_tip_.front(); }  ///< smallest distance from the tip [m]
  double end() const { return from_tip_.back(); }     ///< largest distance from the tip [m]

private:
  std::vector<double> from_tip_;
  std::vector<Eigen::Vector3d> points_;
};

}  // namespace endovascular_sim::intervention
