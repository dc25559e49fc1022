#pragma once

#include <algorithm>

namespace endovascular_sim::nodes
{

/** Keeps a loop that has no time left from taking all of its processor. Linux stops real-time scheduling there for 50
 * ms whenever it has left no rest for 950 (`kernel.sched_rt_runtime_us`): a pause that the hand would feel. Resting a
 * little now and then costs the same time and is not felt. */
class RtThrottleGuard
{
public:
  /** @param share of the time that is to be left, 0 for none
   *  @param rest least time for which it pays to sleep [s] */
  RtThrottleGuard(double share, double rest) : share_(share), rest_(rest) {}

  /** After a turn of the loop.
   *  @param slept, busy what it waited for its time and what it worked then [s]
   *  @return how long to sleep now, mostly 0 [s] */
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
  double due_ = 0.0;  ///< rest that was not taken yet [s]
};

}  // namespace endovascular_sim::nodes
