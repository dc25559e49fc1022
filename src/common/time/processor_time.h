#pragma once

#include <ctime>

namespace endovascular_sim
{

/** Processor time of the calling thread [s]; unlike wall-clock time it excludes other programs. */
inline double processorSeconds()
{
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace endovascular_sim
