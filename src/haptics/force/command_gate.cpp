#include "haptics/force/command_gate.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace endovascular_sim::haptics
{
namespace
{

/** Value moved towards a target by at most a step. */
double approach(double value, double target, double step)
{
  return value + std::clamp(target - value, -step, step);
}

}  // namespace

CommandVerdict CommandGate::examine(const HandMotion& command) const
{
  if (!isFinite(command))
    return CommandVerdict::kNotFinite;
  if (std::abs(command.insertion) > travel_ || std::abs(command.rotation) > 2.0 * M_PI * kLargestTurns)
    return CommandVerdict::kOutOfRange;
  const bool is_first = accepted_ == 0 || silence_ >= kSilence;
  const bool is_near = !isJump(target_, command) || (approaching_ && !isJump(position_, command));
  return is_first || is_near ? CommandVerdict::kAccepted : CommandVerdict::kJump;
}

CommandVerdict CommandGate::offer(const HandMotion& command)
{
  const CommandVerdict verdict = examine(command);
  switch (verdict)
  {
    case CommandVerdict::kNotFinite:
      ++rejected_.not_finite;
      return verdict;
    case CommandVerdict::kOutOfRange:
      ++rejected_.out_of_range;
      return verdict;
    case CommandVerdict::kJump:
      ++rejected_.jumps;
      return verdict;
    case CommandVerdict::kAccepted:
      break;
  }
  approaching_ = approaching_ || accepted_ == 0 || silence_ >= kSilence;
  ++accepted_;
  silence_ = 0.0;
  target_ = command;
  return verdict;
}

const HandMotion& CommandGate::next(double dt)
{
  silence_ += dt;
  approaching_ = approaching_ || isJump(position_, target_);
  if (approaching_)
  {
    position_.insertion = approach(position_.insertion, target_.insertion, kApproachSpeed * dt);
    position_.rotation = approach(position_.rotation, target_.rotation, kApproachTurn * dt);
    approaching_ = position_.insertion != target_.insertion || position_.rotation != target_.rotation;
  }
  else
    position_ = target_;
  return position_;
}

double CommandGate::silence() const
{
  return accepted_ > 0 ? silence_ : std::numeric_limits<double>::infinity();
}

}  // namespace endovascular_sim::haptics
