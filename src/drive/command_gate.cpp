#include "drive/command_gate.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace endovascular_sim::drive
{
namespace
{

/** Largest speed relative to that of the stream at which the position makes up for delayed commands [1]. */
constexpr double kCatchUp = 1.25;

/** Value moved towards a target by at most a step. */
double approach(double value, double target, double step)
{
  return value + std::clamp(target - value, -step, step);
}

/** Moves a value towards a target by little more than the longest motion by one command.
 *  @param longest becomes 0 at the target */
void pursue(double& value, double target, double& longest)
{
  const double step = kCatchUp * longest;
  if (std::abs(target - value) > step)
  {
    value = approach(value, target, step);
    return;
  }
  value = target;
  longest = 0.0;
}

}  // namespace

void RejectedCommands::add(CommandVerdict verdict)
{
  malformed += verdict == CommandVerdict::kMalformed;
  not_finite += verdict == CommandVerdict::kNotFinite;
  out_of_range += verdict == CommandVerdict::kOutOfRange;
  jumps += verdict == CommandVerdict::kJump;
  foreign += verdict == CommandVerdict::kForeign;
  not_enabled += verdict == CommandVerdict::kNotEnabled;
}

bool CommandGate::isNear(const HandMotion& command) const
{
  return !isJump(target_, command, limits_.step, limits_.turn) ||
         (approaching_ && !isJump(position_, command, limits_.step, limits_.turn));
}

/** Judges a command; where the limits clamp, it is changed. */
CommandVerdict CommandGate::examine(HandMotion& command, const HandMotion& slipped)
{
  if (!isFinite(command))
    return CommandVerdict::kNotFinite;
  const HandMotion within{commandRange(*limits_.insertion, slipped.insertion).nearest(command.insertion),
                          commandRange(limits_.rotation, slipped.rotation).nearest(command.rotation)};
  const bool in_range = within.insertion == command.insertion && within.rotation == command.rotation;
  if (!in_range && limits_.beyond == BeyondLimit::kRefuse)
    return CommandVerdict::kOutOfRange;
  command = within;
  const bool is_jump = !isFirst() && !isNear(command);
  if (is_jump && limits_.beyond == BeyondLimit::kRefuse)
    return CommandVerdict::kJump;
  approaching_ = approaching_ || is_jump;
  rejected_.clamped += !in_range || is_jump;
  return CommandVerdict::kAccepted;
}

CommandVerdict CommandGate::offer(HandMotion command, const HandMotion& slipped)
{
  const CommandVerdict verdict = examine(command, slipped);
  rejected_.add(verdict);
  if (verdict != CommandVerdict::kAccepted)
    return verdict;
  approaching_ = approaching_ || isFirst();
  ++accepted_;
  silence_ = 0.0;
  longest_.insertion = std::max(longest_.insertion, std::abs(command.insertion - target_.insertion));
  longest_.rotation = std::max(longest_.rotation, std::abs(command.rotation - target_.rotation));
  target_ = command;
  return verdict;
}

void CommandGate::stopAt(const Interval& stops)
{
  target_.insertion = stops.nearest(target_.insertion);
  longest_.insertion = std::max(longest_.insertion, std::abs(position_.insertion - stops.nearest(position_.insertion)));
}

void CommandGate::follow(const HandMotion& position, double dt)
{
  silence_ += dt;
  target_ = position_ = position;
  longest_ = {};
  approaching_ = false;
}

/** Advances a stream by a step. A command that has come alone is followed at once. */
void CommandGate::followStream()
{
  pursue(position_.insertion, target_.insertion, longest_.insertion);
  pursue(position_.rotation, target_.rotation, longest_.rotation);
}

const HandMotion& CommandGate::next(double dt)
{
  silence_ += dt;
  approaching_ = approaching_ || isJump(position_, target_, limits_.step, limits_.turn);
  if (approaching_)
  {
    position_.insertion = approach(position_.insertion, target_.insertion, limits_.approach_speed * dt);
    position_.rotation = approach(position_.rotation, target_.rotation, limits_.approach_turning_speed * dt);
    approaching_ = position_.insertion != target_.insertion || position_.rotation != target_.rotation;
    if (!approaching_)
      longest_ = {};
  }
  else
    followStream();
  return position_;
}

double CommandGate::silence() const
{
  return accepted_ > 0 ? silence_ : std::numeric_limits<double>::infinity();
}

}  // namespace endovascular_sim::drive
