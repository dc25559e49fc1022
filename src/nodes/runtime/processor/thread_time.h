#pragma once

#include <time.h>

namespace endovascular_sim::nodes
{

/** Processor time of the calling thread since its start [s]. */
inline double threadProcessorTime()
{
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace endovascular_sim::nodes
