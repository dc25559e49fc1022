#include "drive/drive_limits.h"

#include <algorithm>
#include <tuple>

namespace endovascular_sim::drive
{
namespace
{

auto membersOf(const DriveLimits& limits)
{
  return std::tie(limits.beyond, limits.insertion, limits.rotation, limits.pressure, limits.speed, limits.acceleration,
                  limits.turning_speed, limits.turning_acceleration, limits.step, limits.turn, limits.approach_speed,
                  limits.approach_turning_speed, limits.force, limits.torque, limits.force_gain, limits.torque_gain,
                  limits.time_out);
}

}  // namespace

double Interval::nearest(double value) const
{
  return std::clamp(value, low, high);
}

bool DriveLimits::operator==(const DriveLimits& other) const
{
  return membersOf(*this) == membersOf(other);
}

DriveLimits DriveLimits::completed(double length, double grip_force, double grip_torque) const
{
  DriveLimits limits = *this;
  limits.insertion = insertion.value_or(Interval{-length, length});
  limits.force = force.value_or(grip_force);
  limits.torque = torque.value_or(grip_torque);
  return limits;
}

}  // namespace endovascular_sim::drive
