#pragma once

#include <cmath>

namespace endovascular_sim::nodes
{

/** Rate limiter of messages: passes the first message of every slot of time. */
class Throttle
{
public:
  /** @param rate slots per second [Hz] */
  explicit Throttle(double rate) : rate_(rate) {}

  /** Reports whether a message passes. @param time time of the message [s]; may jump backwards */
  bool passes(double time)
  {
    const double slot = std::floor(time * rate_ + 1e-6);
    if (slot == last_slot_)
      return false;
    last_slot_ = slot;
    return true;
  }

private:
  double rate_;
  double last_slot_ = -1.0;
};

}  // namespace endovascular_sim::nodes
