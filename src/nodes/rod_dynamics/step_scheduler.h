#pragma once

#include <algorithm>
#include <chrono>

namespace endovascular_sim::nodes
{

/** When the steps of a loop begin that keeps up with the clock. One that is late catches up, but never so fast that a
 *  hand would feel it; what it is further behind than it may catch up is let go. */
class StepScheduler
{
public:
  using Clock = std::chrono::steady_clock;

  /** @param step simulated time of a step [s] */
  explicit StepScheduler(double step) : slot_(period(step)), least_(period(step / kCatchUp)) {}

  /** The next step belongs now, whatever was before. */
  void start(Clock::time_point now)
  {
    slot_begin_ = now;
    begun_ = now - slot_;
  }

  /** When the next step may begin. */
  Clock::time_point next() const { return std::max(slot_begin_, begun_ + least_); }

  void begin(Clock::time_point now) { begun_ = now; }

  /** When the step that was begun should have ended. */
  Clock::time_point slotEnd() const { return slot_begin_ + slot_; }

  /** After a step. @return whether time was let go */
  bool end(Clock::time_point now)
  {
    slot_begin_ += slot_;
    if (now - slot_begin_ <= period(kMostBehind))
      return false;
    slot_begin_ = now;
    return true;
  }

  static Clock::duration period(double seconds)
  {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }

private:
  static constexpr double kCatchUp = 1.25;    // times real time
  static constexpr double kMostBehind = 0.5;  // s

  Clock::duration slot_, least_;
  Clock::time_point slot_begin_, begun_;
};

}  // namespace endovascular_sim::nodes
