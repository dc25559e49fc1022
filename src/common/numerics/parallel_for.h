#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace endovascular_sim
{

/** Number of threads for a choice of a user: 0 selects the number of processors, at most 8. */
inline int threadCount(int wanted)
{
  if (wanted > 0)
    return wanted;
  return static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 8U));
}

/** Calls a function once for every index below a count, on several threads. The order of the calls is undefined, so the
 *  calls must be independent of each other; the results then do not depend on the number of threads.
 *  @param threads number of threads, the calling one included
 *  @throws the first exception of a call; calls that have not begun are omitted then */
template <typename Function>
void parallelFor(std::size_t count, int threads, const Function& function)
{
  std::atomic<std::size_t> next{0};
  std::exception_ptr error;
  std::mutex mutex;
  const auto work = [&]
  {
    for (std::size_t k = next++; k < count; k = next++)
    {
      try
      {
        function(k);
      }
      catch (...)
      {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!error)
          error = std::current_exception();
        next = count;
      }
    }
  };
  std::vector<std::thread> helpers;
  for (std::size_t k = 1; k < std::min(static_cast<std::size_t>(std::max(threads, 1)), count); ++k)
    helpers.emplace_back(work);
  work();
  for (std::thread& helper : helpers)
    helper.join();
  if (error)
    std::rethrow_exception(error);
}

}  // namespace endovascular_sim
