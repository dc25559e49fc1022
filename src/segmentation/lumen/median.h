#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace endovascular_sim::segmentation
{

/** Upper median of one or more values, whose order it changes. */
inline double median(std::vector<double>& values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace endovascular_sim::segmentation
