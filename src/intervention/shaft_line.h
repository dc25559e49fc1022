#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::intervention
{

/** The shaft of an instrument in space, asked by the distance from its tip. */
class ShaftLine
{
public:
  /** @param from_tip of the points, ascending or descending, two or more [m]
   *  @param points [m] */
  ShaftLine(std::vector<double> from_tip, std::vector<Eigen::Vector3d> points)
    : from_tip_(std::move(from_tip)), points_(std::move(points))
  {
    if (from_tip_.front() <= from_tip_.back())
      return;
    std::reverse(from_tip_.begin(), from_tip_.end());
    std::reverse(points_.begin(), points_.end());
  }

  /** Straight on beyond the ends. */
  Eigen::Vector3d at(double from_tip) const
  {
    const auto next = std::upper_bound(from_tip_.begin() + 1, from_tip_.end() - 1, from_tip);
    const auto k = static_cast<std::size_t>(next - from_tip_.begin());
    const double t = (from_tip - from_tip_[k - 1]) / (from_tip_[k] - from_tip_[k - 1]);
    return points_[k - 1] + t * (points_[k] - points_[k - 1]);
  }

  double begin() const { return from_tip_.front(); }  ///< [m]
  double end() const { return from_tip_.back(); }     ///< [m]

private:
  std::vector<double> from_tip_;
  std::vector<Eigen::Vector3d> points_;
};

}  // namespace endovascular_sim::intervention
