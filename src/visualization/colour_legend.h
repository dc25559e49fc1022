#pragma once

#include <string>
#include <vector>

#include "visualization/force_colour.h"

namespace endovascular_sim::visualization
{

/** Scale of a legend: from 0 to a round full scale, with labelled ticks. */
struct LegendScale
{
  double full = 1.0;                ///< value at the upper end, 1, 2 or 5 times a power of ten
  std::vector<double> ticks;        ///< from 0 to the full scale
  std::vector<std::string> labels;  ///< of the ticks, in a unit with a decimal prefix
  std::string unit;                 ///< unit with its prefix, e.g. mN
};

/** Smallest round full scale that is not below a value.
 *  @param value largest value to be shown; not positive or not finite: the smallest scale
 *  @param smallest smallest full scale, positive */
double roundFullScale(double value, double smallest);

/** Legend of a scale.
 *  @param full full scale, positive
 *  @param unit unit without prefix, e.g. N; prefixes are milli and micro */
LegendScale legendScale(double full, const std::string& unit);

/** Full scale that follows the largest value of a scene. It grows at once, and does not shrink before reset(): equal
 *  colours keep their meaning during a run. */
class FollowingScale
{
public:
  explicit FollowingScale(double smallest) : smallest_(smallest), full_(smallest) {}

  /** @return true if the full scale has changed */
  bool follow(double largest);
  void reset() { full_ = smallest_; }
  double full() const { return full_; }

private:
  double smallest_;
  double full_;
};

}  // namespace endovascular_sim::visualization
