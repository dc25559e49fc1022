#pragma once

#include <cstddef>
#include <vector>

namespace endovascular_sim::haptics
{

/** Record of all durations, for exact percentiles. */
class LatencyRecord
{
public:
  void add(double seconds) { values_.push_back(seconds); }
  std::size_t count() const { return values_.size(); }
  /** Nearest-rank percentile: smallest value that at least @p fraction of all values do not exceed [s]; 0 if empty. */
  double percentile(double fraction) const;

private:
  std::vector<double> values_;
};

}  // namespace endovascular_sim::haptics
