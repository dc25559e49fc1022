#include "drive/axis_control.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::drive
{
namespace
{

/** Largest lead of the setpoint over the instrument in the velocity and effort modes, as a time at the present speed
 *  [s]. An instrument that is stopped then follows a reversed command after this time at the latest. */
constexpr double kLead = 0.05;
constexpr double kSlack = 1e-6;  ///< lead that is always permitted [m or rad]

}  // namespace

void AxisControl::follow(double position)
{
  mode_ = Mode::kVelocity;
  target_ = velocity_ = 0.0;
  position_ = position;
}

void AxisControl::hold()
{
  setVelocity(0.0);
}

void AxisControl::setVelocity(double velocity)
{
  mode_ = Mode::kVelocity;
  target_ = std::clamp(velocity, -limits_.speed, limits_.speed);
}

void AxisControl::setEffort(double effort)
{
  mode_ = Mode::kEffort;
  target_ = effort;
}

void AxisControl::moveTo(double goal)
{
  mode_ = Mode::kMove;
  move_time_ = 0.0;
  move_ = TrapezoidalMove(position_, velocity_, goal, limits_.move_speed, limits_.acceleration);
}

double AxisControl::wantedVelocity(double effort) const
{
  if (mode_ == Mode::kVelocity)
    return target_;
  return std::clamp(limits_.gain * (target_ - effort), -limits_.speed, limits_.speed);
}

/** Position nearest to @p position at which the instrument is within the range and between its stops. */
double AxisControl::permitted(double position, const AxisFeedback& feedback) const
{
  return feedback.stops.nearest(limits_.range.shifted(feedback.slipped).nearest(position));
}

void AxisControl::integrate(double dt, const AxisFeedback& feedback)
{
  const double change = limits_.acceleration * dt;
  velocity_ += std::clamp(wantedVelocity(feedback.effort) - velocity_, -change, change);
  // The speed from which the axis can stop at the end of the range.
  const Interval range = limits_.range.shifted(feedback.slipped);
  const double high = feedback.stops.nearest(range.high);
  const double low = feedback.stops.nearest(range.low);
  const double up = std::sqrt(2.0 * limits_.acceleration * std::max(0.0, high - position_));
  const double down = std::sqrt(2.0 * limits_.acceleration * std::max(0.0, position_ - low));
  const double wanted = wantedVelocity(feedback.effort);
  is_stopped_ = (wanted > 0.0 && position_ > high - kSlack) || (wanted < 0.0 && position_ < low + kSlack);
  velocity_ = std::clamp(velocity_, -down, up);
  position_ += dt * velocity_;
  const double lead = kLead * std::abs(velocity_) + kSlack;
  position_ = std::clamp(position_, feedback.reached - lead, feedback.reached + lead);
  position_ = permitted(position_, feedback);
}

double AxisControl::next(double dt, const AxisFeedback& feedback)
{
  if (mode_ != Mode::kMove)
  {
    integrate(dt, feedback);
    return position_;
  }
  // A move that is over at once still lasts a step, so that it can be observed.
  const bool is_over = move_time_ >= move_.duration() && move_time_ > 0.0;
  move_time_ += dt;
  position_ = permitted(move_.position(move_time_), feedback);
  is_stopped_ = position_ != move_.position(move_time_);
  velocity_ = move_.velocity(move_time_);
  if (is_over)
    follow(permitted(move_.goal(), feedback));
  return position_;
}

}  // namespace endovascular_sim::drive
