#pragma once

#include <ctime>

namespace endovascular_sim::benchmark
{

/** Time that this thread has had of a processor [s]: unlike a clock, it leaves out what other programs took. */
inline double processorSeconds()
{
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace endovascular_sim::benchmark
