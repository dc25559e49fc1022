#include "robot/play_axis.h"

#include <cmath>

#include "robot/backlash.h"

namespace endovascular_sim::robot
{

using drive::CommandKind;

bool isByRate(CommandKind kind)
{
  return kind == CommandKind::kServoVelocity || kind == CommandKind::kServoForce;
}

bool isRelative(CommandKind kind)
{
  return kind == CommandKind::kServoRelative || kind == CommandKind::kMoveRelative;
}

double PlayAxis::command(const JointLink& joint, CommandKind kind, double value)
{
  if (isByRate(kind))
  {
    rate = kind == CommandKind::kServoVelocity ? joint.ratio * value : value / joint.ratio;
    engaged = isEngaged(driven, driving, joint.backlash, rate);
    if (kind == CommandKind::kServoForce && rate != 0.0)
      driving = driven + std::copysign(0.5 * joint.backlash, rate);
    return rate;
  }
  rate = 0.0;
  const double origin = kind == CommandKind::kMoveRelative ? setpoint : driven;
  if (kind == CommandKind::kMoveRelative)
    driving = drivingAfterPlay(driving, setpoint, joint.backlash);
  driving = isRelative(kind) ? driving + joint.ratio * value : joint.toMotion(value);
  wanted = driving;
  driven = drivenAfterPlay(origin, driving, joint.backlash);
  return isRelative(kind) ? driven - origin : driven;
}

bool PlayAxis::follow(double setpoint_of_step, CommandKind kind, bool is_over, double dt, double play)
{
  const bool by_rate = isByRate(kind);
  setpoint = setpoint_of_step;
  if (!by_rate && !is_over)
    return false;  // the command may not have arrived yet
  driven = setpoint;
  bool has_engaged = false;
  if (by_rate && !is_over && rate != 0.0)
  {
    const bool moves = engaged || kind == CommandKind::kServoForce;
    driving = moves ? driven + std::copysign(0.5 * play, rate) : driving + rate * dt;
    engaged = moves || isEngaged(driven, driving, play, rate);
    has_engaged = engaged != moves;
  }
  if (by_rate)
    wanted = driving;
  driving = drivingAfterPlay(wanted, driven, play);  // a move may outlast the time-out
  return has_engaged;
}

}  // namespace endovascular_sim::robot
