#include "drive/hand_control.h"

#include <cmath>

namespace endovascular_sim::drive
{
namespace
{

AxisLimits insertionLimits(const DriveLimits& limits)
{
  return {*limits.insertion, limits.speed, limits.acceleration, limits.approach_speed, limits.force_gain};
}

AxisLimits rotationLimits(const DriveLimits& limits)
{
  return {limits.rotation, limits.turning_speed, limits.turning_acceleration, limits.approach_turning_speed,
          limits.torque_gain};
}

bool isFinite(const JointCommand& command)
{
  return std::isfinite(command.insertion) && std::isfinite(command.rotation.value_or(0.0));
}

}  // namespace

HandControl::HandControl(const HandMotion& start, const DriveLimits& limits)
  : start_(start),
    limits_(limits),
    gate_(start, limits),
    insertion_(insertionLimits(limits), start.insertion),
    rotation_(rotationLimits(limits), start.rotation),
    setpoint_{start, std::nullopt},
    arbiter_("instrument", limits.time_out)
{
}

CommandVerdict HandControl::command(const std::string& client, const std::optional<JointCommand>& command)
{
  CommandVerdict verdict = examine(client, command);
  if (verdict == CommandVerdict::kAccepted)
    verdict = execute(*command);
  if (verdict == CommandVerdict::kAccepted)
  {
    arbiter_.accept(client);
    return verdict;
  }
  reject(verdict, command ? nameOf(command->kind) : "command", client);
  const bool was_move =
      command && (command->kind == CommandKind::kMovePosition || command->kind == CommandKind::kMoveRelative);
  state_.revision += was_move;  // publishes the state: the replaced move has ended
  return verdict;
}

CommandVerdict HandControl::examine(const std::string& client, const std::optional<JointCommand>& command)
{
  if (!command)
    return CommandVerdict::kMalformed;
  if (arbiter_.isDrivenByAnother(client))
    return CommandVerdict::kForeign;
  const bool is_absolute = command->kind == CommandKind::kServoPosition || command->kind == CommandKind::kMovePosition;
  if (state_.state != OperatingState::kEnabled || is_homing_ || (is_absolute && !state_.is_homed))
    return CommandVerdict::kNotEnabled;
  return isFinite(*command) ? CommandVerdict::kAccepted : CommandVerdict::kNotFinite;
}

/** @return false */
bool HandControl::reject(CommandVerdict verdict, const std::string& command, const std::string& client)
{
  arbiter_.reject(verdict, command, client, reasonOf(verdict));
  return false;
}

std::string HandControl::reasonOf(CommandVerdict verdict) const
{
  switch (verdict)
  {
    case CommandVerdict::kMalformed:
      return "joints missing or repeated, or a pressure out of range";
    case CommandVerdict::kNotFinite:
      return "not finite";
    case CommandVerdict::kOutOfRange:
      return "beyond drive.limits (range, speed, force or torque)";
    case CommandVerdict::kJump:
      return "a jump of more than drive.limits.step or turn from the last accepted position";
    case CommandVerdict::kForeign:
      return arbiter_.foreignReason();
    case CommandVerdict::kNotEnabled:
      if (state_.state != OperatingState::kEnabled)
        return std::string("the instrument is ") + nameOf(state_.state);
      return is_homing_ ? "the instrument is homing" : "not homed";
    case CommandVerdict::kAccepted:
      break;
  }
  return "";
}

/** Replaces a value beyond an interval where the limits clamp. @return false where they refuse */
bool HandControl::isPermitted(double& value, const Interval& interval, bool& clamped) const
{
  if (interval.contains(value))
    return true;
  clamped = true;
  value = interval.nearest(value);
  return limits_.beyond == BeyondLimit::kClamp;
}

/** Pressure after a command; empty if the command does not change it. */
std::optional<double> HandControl::wantedPressure(const JointCommand& command) const
{
  const bool is_relative = command.kind == CommandKind::kServoRelative || command.kind == CommandKind::kMoveRelative;
  if (!command.pressure || !is_relative)
    return command.pressure;
  return setpoint_.pressure.value_or(0.0) + *command.pressure;
}

CommandVerdict HandControl::execute(JointCommand command)
{
  const std::optional<double> pressure = wantedPressure(command);
  if (pressure && !limits_.pressure.contains(*pressure))
    return CommandVerdict::kMalformed;
  CommandVerdict verdict = CommandVerdict::kAccepted;
  switch (command.kind)
  {
    case CommandKind::kServoPosition:
    case CommandKind::kServoRelative:
      verdict = stream(command);
      break;
    case CommandKind::kServoVelocity:
    case CommandKind::kServoForce:
      verdict = rate(command);
      break;
    case CommandKind::kMovePosition:
    case CommandKind::kMoveRelative:
      verdict = move(command);
      break;
  }
  if (verdict == CommandVerdict::kAccepted && pressure)
    setpoint_.pressure = pressure;
  return verdict;
}

CommandVerdict HandControl::stream(const JointCommand& command)
{
  const bool streams = mode_ == Mode::kStream || mode_ == Mode::kIncrements;
  HandMotion target = streams ? gate_.target() : setpoint_.motion;
  if (command.kind == CommandKind::kServoPosition)
  {
    target.insertion = command.insertion;
    target.rotation = command.rotation.value_or(target.rotation);
  }
  else
  {
    target.insertion += command.insertion;
    target.rotation += command.rotation.value_or(0.0);
  }
  const CommandVerdict verdict = gate_.offer(target, slipped_);
  if (verdict != CommandVerdict::kAccepted)
    return verdict;
  endMove();
  mode_ = command.kind == CommandKind::kServoPosition ? Mode::kStream : Mode::kIncrements;
  return verdict;
}

CommandVerdict HandControl::rate(JointCommand command)
{
  const bool by_force = command.kind == CommandKind::kServoForce;
  const double most = by_force ? *limits_.force : limits_.speed;
  const double most_turning = by_force ? *limits_.torque : limits_.turning_speed;
  bool clamped = false;
  double turning = command.rotation.value_or(0.0);
  if (!isPermitted(command.insertion, {-most, most}, clamped) ||
      !isPermitted(turning, {-most_turning, most_turning}, clamped))
    return CommandVerdict::kOutOfRange;
  arbiter_.countClamped(clamped);
  enterRate();
  by_force ? insertion_.setEffort(command.insertion) : insertion_.setVelocity(command.insertion);
  if (!command.rotation)
    rotation_.hold();
  else
    by_force ? rotation_.setEffort(turning) : rotation_.setVelocity(turning);
  return CommandVerdict::kAccepted;
}

CommandVerdict HandControl::move(const JointCommand& command)
{
  HandMotion goal = setpoint_.motion;
  const bool is_relative = command.kind == CommandKind::kMoveRelative;
  goal.insertion = is_relative ? goal.insertion + command.insertion : command.insertion;
  goal.rotation =
      is_relative ? goal.rotation + command.rotation.value_or(0.0) : command.rotation.value_or(goal.rotation);
  bool clamped = false;
  if (!isPermitted(goal.insertion, commandRange(*limits_.insertion, slipped_.insertion), clamped) ||
      !isPermitted(goal.rotation, commandRange(limits_.rotation, slipped_.rotation), clamped))
    return CommandVerdict::kOutOfRange;
  arbiter_.countClamped(clamped);
  enterRate();
  insertion_.moveTo(goal.insertion);
  rotation_.moveTo(goal.rotation);
  mode_ = Mode::kMove;
  state_.is_busy = true;
  ++state_.revision;
  return CommandVerdict::kAccepted;
}

/** Hands the setpoint over from a stream to the axes. */
void HandControl::enterRate()
{
  endMove();
  if (mode_ == Mode::kStream || mode_ == Mode::kIncrements)
  {
    insertion_.follow(setpoint_.motion.insertion);
    rotation_.follow(setpoint_.motion.rotation);
  }
  mode_ = Mode::kRate;
}

void HandControl::endMove()
{
  if (!state_.is_busy)
    return;
  state_.is_busy = is_homing_ = false;
  ++state_.revision;
}

void HandControl::stop()
{
  enterRate();
  insertion_.hold();
  rotation_.hold();
}

void HandControl::setState(OperatingState state, const std::string& reason)
{
  state_.state = state;
  state_.reason = reason;
}

bool HandControl::stateCommand(const std::string& client, const std::string& word)
{
  ++state_.revision;  // every command is answered by a state
  if (!arbiter_.permits(client, word))
    return false;
  if (word == "hold" || word == "free")
    return holdOrFree(client, word);
  if (word == "home")
    return home(client);
  if (word == "enable" && state_.state == OperatingState::kDisabled)
    setState(OperatingState::kEnabled, "");
  else if (word == "disable")
  {
    stop();
    arbiter_.release();
    setState(OperatingState::kDisabled, "disabled by " + client);
  }
  else if (word == "pause" && state_.state == OperatingState::kEnabled)
  {
    stop();
    setState(OperatingState::kPaused, "paused by " + client + "; continues with resume");
  }
  else if (word == "resume" && state_.state == OperatingState::kPaused)
    setState(OperatingState::kEnabled, "");
  else if (word == "unhome")
  {
    stop();
    state_.is_homed = false;
  }
  return true;
}

bool HandControl::holdOrFree(const std::string& client, const std::string& word)
{
  if (state_.state != OperatingState::kEnabled || is_homing_)
    return reject(CommandVerdict::kNotEnabled, word, client);
  stop();
  if (word == "free")
  {
    insertion_.setEffort(0.0);
    rotation_.setEffort(0.0);
    mode_ = Mode::kFree;
  }
  arbiter_.accept(client);
  return true;
}

/** Moves to the position at the start of the scene, where the instrument is homed. */
bool HandControl::home(const std::string& client)
{
  if (state_.is_homed || is_homing_)
    return true;
  if (state_.state != OperatingState::kEnabled)
    return reject(CommandVerdict::kNotEnabled, "home", client);
  arbiter_.take(client);
  is_homing_ =
      move({CommandKind::kMovePosition, start_.insertion, start_.rotation, std::nullopt}) == CommandVerdict::kAccepted;
  return true;
}

const HandSetpoint& HandControl::next(double dt, const HandFeedback& feedback)
{
  arbiter_.advance(dt);
  slipped_ = {feedback.insertion.slipped, feedback.rotation.slipped};
  is_stopped_ = mode_ == Mode::kIncrements && !feedback.insertion.stops.contains(gate_.target().insertion);
  if (mode_ == Mode::kIncrements)
    gate_.stopAt(feedback.insertion.stops);
  if (mode_ == Mode::kStream || mode_ == Mode::kIncrements)
  {
    setpoint_.motion = gate_.next(dt);
    return setpoint_;
  }
  if (mode_ == Mode::kRate && arbiter_.isTimedOut())
    stop();
  setpoint_.motion = {insertion_.next(dt, feedback.insertion), rotation_.next(dt, feedback.rotation)};
  is_stopped_ = insertion_.isStopped();
  gate_.follow(setpoint_.motion, dt);
  if (mode_ != Mode::kMove)
    return setpoint_;
  arbiter_.keepDriver();  // the sender of a move drives until its end
  if (insertion_.isMoving() || rotation_.isMoving())
    return setpoint_;
  state_.is_homed = state_.is_homed || is_homing_;
  endMove();
  mode_ = Mode::kRate;
  return setpoint_;
}

void HandControl::restAt(const HandMotion& position, std::optional<double> pressure)
{
  endMove();
  setpoint_ = {position, pressure};
  insertion_.follow(position.insertion);
  rotation_.follow(position.rotation);
  gate_.follow(position, 0.0);
  mode_ = Mode::kRate;
  arbiter_.release();
}

HandMotion HandControl::goal() const
{
  return mode_ == Mode::kStream || mode_ == Mode::kIncrements ? gate_.target()
                                                              : HandMotion{insertion_.goal(), rotation_.goal()};
}

RejectedCommands HandControl::rejected() const
{
  RejectedCommands all = arbiter_.rejected();
  all.clamped += gate_.rejected().clamped;
  return all;
}

bool give(HandControl& control, const std::string& client, const std::string& word,
          const std::vector<std::string>& names, const std::vector<double>& values)
{
  const std::optional<CommandKind> kind = commandKind(word);
  return kind ? control.command(client, jointCommand(*kind, names, values)) == CommandVerdict::kAccepted
              : control.stateCommand(client, word);
}

}  // namespace endovascular_sim::drive
