#include "haptics/force/force_output.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::haptics
{

namespace
{

// Longest interval that the rate limiter integrates. It prevents a jump of the force after a pause [s].
constexpr double kLongestStep = 10e-3;

double approach(double value, double target, double largest_change)
{
  return value + std::clamp(target - value, -largest_change, largest_change);
}

}  // namespace

bool ForceOutput::command(const HandForce& wanted, double now)
{
  if (!std::isfinite(wanted.force) || !std::isfinite(wanted.torque))
  {
    release(now);
    return false;
  }
  advance(now);
  releasing_ = false;
  target_.force = std::clamp(wanted.force, -limits_.force, limits_.force);
  target_.torque = std::clamp(wanted.torque, -limits_.torque, limits_.torque);
  return true;
}

void ForceOutput::release(double now)
{
  if (releasing_)
    return;
  releasing_ = returning_ = true;
  release_from_ = value_;
  release_time_ = now;
  target_ = HandForce();
}

void ForceOutput::cut()
{
  releasing_ = returning_ = true;
  value_ = target_ = release_from_ = HandForce();
}

HandForce ForceOutput::advance(double now)
{
  if (releasing_)
  {
    const double left = std::clamp(1.0 - (now - release_time_) / limits_.ramp_time, 0.0, 1.0);
    value_ = left > 0.0 ? HandForce{release_from_.force * left, release_from_.torque * left} : HandForce();
  }
  else
  {
    const double step = std::clamp(now - time_, 0.0, kLongestStep);
    double force_rate = limits_.force_rate;
    double torque_rate = limits_.torque_rate;
    if (returning_)
    {
      force_rate = std::min(force_rate, limits_.force / limits_.return_time);
      torque_rate = std::min(torque_rate, limits_.torque / limits_.return_time);
    }
    value_.force = approach(value_.force, target_.force, force_rate * step);
    value_.torque = approach(value_.torque, target_.torque, torque_rate * step);
    if (step > 0.0 && !isMoving())
      returning_ = false;
  }
  time_ = now;
  return value_;
}

}  // namespace endovascular_sim::haptics
