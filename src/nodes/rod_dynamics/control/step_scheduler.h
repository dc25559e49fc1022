#pragma once

#include <algorithm>
#include <chrono>

namespace endovascular_sim::nodes
{

/** Start times of the steps of a loop that follows the clock.
 *
 *  A late loop catches up at most kCatchUp times as fast as real time, which the user's hand does not feel. A backlog
 *  beyond kMostBehind is discarded. */
class StepScheduler
{
public:
  using Clock = std::chrono::steady_clock;

  /** @param step simulated duration of a step [s] */
  explicit StepScheduler(double step) : slot_(period(step)), shortest_(period(step / kCatchUp)) {}

  /** Starts the slots at the given time and discards any backlog. */
  void start(Clock::time_point now)
  {
    slot_begin_ = now;
    started_ = now - slot_;
  }

  /** Earliest start of the next step. */
  Clock::time_point next() const { return std::max(slot_begin_, started_ + shortest_); }

  /** Records the start of a step. */
  void begin(Clock::time_point now) { started_ = now; }

  /** Deadline of the current step. */
  Clock::time_point slotEnd() const { return slot_begin_ + slot_; }

  /** Records the end of a step. @return true when a backlog was discarded */
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
  static constexpr double kCatchUp = 1.25;    ///< largest speed relative to real time [1]
  static constexpr double kMostBehind = 0.5;  ///< largest backlog [s]

  Clock::duration slot_, shortest_;         ///< duration of a slot, shortest interval between two starts
  Clock::time_point slot_begin_, started_;  ///< start of the slot, of the step in it
};

}  // namespace endovascular_sim::nodes
