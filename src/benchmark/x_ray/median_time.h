#pragma once

#include <algorithm>
#include <vector>

#include "common/time/processor_time.h"

namespace endovascular_sim::benchmark
{

/** Processor time of a task [ms]. */
template <typename Work>
double timeOf(const Work& work)
{
  const double begin = processorSeconds();
  work();
  return 1e3 * (processorSeconds() - begin);
}

/** Median of numbers; 0 without any. */
inline double medianOf(std::vector<double> values)
{
  if (values.empty())
    return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/** Median of the processor times of a repeated task [ms]. */
template <typename Work>
double medianOf(int times, const Work& work)
{
  std::vector<double> all;
  for (int k = 0; k < times; ++k)
    all.push_back(timeOf(work));
  return medianOf(std::move(all));
}

}  // namespace endovascular_sim::benchmark
