#include "drive/trapezoidal_move.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::drive
{

TrapezoidalMove::TrapezoidalMove(double start, double velocity, double goal, double speed, double acceleration)
  : start_(start), goal_(goal)
{
  const double stop = start + velocity * std::abs(velocity) / (2.0 * acceleration);
  direction_ = goal >= stop ? 1.0 : -1.0;
  velocity_ = direction_ * velocity;
  const double distance = direction_ * (goal - start);
  // distance = ramp + braking = (c² − v²)/2a + c²/2a for a move without a cruise.
  const double highest = std::sqrt(std::max(0.0, acceleration * distance + 0.5 * velocity_ * velocity_));
  cruising_ = std::min(speed, highest);
  ramp_ = std::abs(cruising_ - velocity_) / acceleration;
  braking_ = cruising_ / acceleration;
  const double moved = 0.5 * (velocity_ + cruising_) * ramp_ + 0.5 * cruising_ * braking_;
  cruise_ = cruising_ > 0.0 ? std::max(0.0, distance - moved) / cruising_ : 0.0;
}

double TrapezoidalMove::position(double time) const
{
  if (time >= duration())
    return goal_;
  if (time <= ramp_)
  {
    const double mean = velocity_ + (ramp_ > 0.0 ? 0.5 * (cruising_ - velocity_) * time / ramp_ : 0.0);
    return start_ + direction_ * mean * time;
  }
  const double left = duration() - time;  // measured from the goal, so that the end has no rounding error
  if (left <= braking_)
    return goal_ - direction_ * 0.5 * cruising_ * left * left / braking_;
  return goal_ - direction_ * cruising_ * (left - 0.5 * braking_);
}

double TrapezoidalMove::velocity(double time) const
{
  if (time >= duration())
    return 0.0;
  if (time <= ramp_)
    return direction_ * (velocity_ + (ramp_ > 0.0 ? (cruising_ - velocity_) * time / ramp_ : 0.0));
  const double left = duration() - time;
  return direction_ * cruising_ * (left <= braking_ ? left / braking_ : 1.0);
}

}  // namespace endovascular_sim::drive
