#pragma once

#include <algorithm>

namespace endovascular_sim::nodes
{

/** Scheduler of short sleeps that keep an overloaded real-time loop below the limit of Linux's real-time throttling.
 *
 *  By default Linux stops the real-time threads of a processor for 50 ms when they have run for 950 ms without a pause
 *  (`kernel.sched_rt_runtime_us`), which the user's hand would feel. Short sleeps cost the same time and are not felt.
 */
class RtThrottleGuard
{
public:
  /** @param share share of the time that must be idle, 0 for none [1]
   *  @param rest duration of one sleep [s] */
  RtThrottleGuard(double share, double rest) : share_(share), rest_(rest) {}

  /** Accounts for one iteration of the loop.
   *  @param slept, busy durations of its sleep and its work [s]
   *  @return duration of the sleep that is due now, usually 0 [s] */
  double after(double slept, double busy)
  {
    due_ = std::max(0.0, due_ + share_ * (slept + busy) - slept);
    if (due_ < rest_)
      return 0.0;
    due_ -= rest_;
    return rest_;
  }

private:
  double share_;
  double rest_;
  double due_ = 0.0;  ///< missing idle time [s]
};

}  // namespace endovascular_sim::nodes
