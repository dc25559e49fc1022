#include "parallel.h"

#include <algorithm>
#include <future>
#include <stdexcept>
#include <string>
#include <thread>

#include <pybind11/pybind11.h>

#include "common/error.h"
#include "common/numerics/parallel_for.h"

namespace endovascular_sim::python
{
namespace
{

/** Thrown in a helping thread; its text reaches nobody. */
class Cancelled : public std::runtime_error
{
public:
  Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace

void StepEnd::operator()() const
{
  if (signals_ != nullptr)
    (*signals_)();
  else if (*cancelled_)
    throw Cancelled();
}

void runParallel(std::size_t count, int threads, const std::function<void(std::size_t, const StepEnd&)>& function)
{
  if (threads < 0)
    throw InputError("threads", std::to_string(threads),
                     "is below 0; give a number of threads, or 0 for one per processor");
  if (threads == 0)
    threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const pybind11::gil_scoped_release released;
  SignalCheck signals;
  if (threads == 1 || count <= 1)
  {
    const StepEnd step_end(&signals, nullptr);
    for (std::size_t k = 0; k < count; ++k)
      function(k, step_end);
    return;
  }
  std::atomic<bool> cancelled{false};
  const StepEnd step_end(nullptr, &cancelled);
  std::future<void> work = std::async(
      std::launch::async, [&] { parallelFor(count, threads, [&](std::size_t k) { function(k, step_end); }); });
  try
  {
    while (work.wait_for(SignalCheck::kInterval) != std::future_status::ready)
      signals();
  }
  catch (...)
  {
    cancelled = true;
    work.wait();
    throw;
  }
  work.get();
}

}  // namespace endovascular_sim::python
