#pragma once

#include <chrono>

namespace endovascular_sim::python
{

/** Handles pending signals of Python, e.g. Ctrl-C, from a long computation without the GIL: at most one look every
 *  50 ms. The clock has no influence on results. */
class SignalCheck
{
public:
  /** To be called often by the thread that Python called.
   *  @throws pybind11::error_already_set with the exception of the signal's handler, e.g. KeyboardInterrupt */
  void operator()()
  {
    const Clock::time_point now = Clock::now();
    if (now < next_)
      return;
    handleSignals();
    next_ = Clock::now() + kInterval;
  }

  static constexpr std::chrono::milliseconds kInterval{50};

private:
  using Clock = std::chrono::steady_clock;

  static void handleSignals();

  Clock::time_point next_ = Clock::now() + kInterval;
};

}  // namespace endovascular_sim::python
