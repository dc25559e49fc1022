#include "haptics/host/latency_record.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::haptics
{

double LatencyRecord::percentile(double fraction) const
{
  if (values_.empty())
    return 0.0;
  const auto rank = static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(values_.size())));
  std::vector<double> sorted = values_;
  const auto nth = sorted.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(sorted.begin(), nth, sorted.end());
  return *nth;
}

}  // namespace endovascular_sim::haptics
