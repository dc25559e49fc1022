#include "robot/robot_control.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/text/format.h"
#include "robot/backlash.h"

namespace endovascular_sim::robot
{
namespace
{

using drive::CommandKind;
using drive::CommandVerdict;
using drive::OperatingState;

constexpr double kRounding = 1e-12;  ///< rounding error of a sum of relative commands, relative to the limit

bool isAbsolute(CommandKind kind)
{
  return kind == CommandKind::kServoPosition || kind == CommandKind::kMovePosition;
}

std::size_t indexOf(Motion motion)
{
  return static_cast<std::size_t>(motion);
}

/** Longest time-out of the instruments [s]. */
double longestTimeOut(const std::vector<RobotInstrument>& instruments)
{
  double longest = 0.0;
  for (const RobotInstrument& instrument : instruments)
    longest = std::max(longest, instrument.time_out);
  return longest;
}

}  // namespace

RobotControl::RobotControl(RobotModel model, std::vector<JointLink> links, std::vector<RobotInstrument> instruments)
  : model_(std::move(model)),
    links_(std::move(links)),
    instruments_(std::move(instruments)),
    channels_(instruments_.size()),
    states_(instruments_.size()),
    arbiter_("robot", longestTimeOut(instruments_))
{
  for (std::size_t k = 0; k < instruments_.size(); ++k)
  {
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      const double start = instruments_[k].start[axis];
      channels_[k].axes[axis] = {std::nullopt, start, start, start, start, 0.0, false};
    }
    states_[k].state = OperatingState::kDisabled;  // until the instrument publishes
    states_[k].reason = "no state of '" + instruments_[k].name + "' yet";
  }
  for (std::size_t link = 0; link < links_.size(); ++link)
  {
    const auto found =
        std::find_if(instruments_.begin(), instruments_.end(),
                     [&](const RobotInstrument& instrument) { return instrument.name == links_[link].instrument; });
    instrument_of_.push_back(static_cast<std::size_t>(found - instruments_.begin()));
    channels_[instrument_of_[link]].axes[indexOf(links_[link].motion)].link = link;
  }
}

/** Values by links. Joints of the URDF that no link moves are ignored, so that a client may send all joints. */
std::optional<RobotControl::Values> RobotControl::assign(const std::vector<std::string>& names,
                                                         const std::vector<double>& values, std::string& reason) const
{
  Values assigned(links_.size());
  if (names.empty())
  {
    if (values.empty() || values.size() > links_.size())
    {
      reason = std::to_string(values.size()) + " values without names for " + std::to_string(links_.size()) + " joints";
      return std::nullopt;
    }
    std::copy(values.begin(), values.end(), assigned.begin());
    return assigned;
  }
  if (names.size() != values.size())
  {
    reason = std::to_string(names.size()) + " names, but " + std::to_string(values.size()) + " values";
    return std::nullopt;
  }
  bool any = false;
  for (std::size_t n = 0; n < names.size(); ++n)
  {
    const auto link =
        std::find_if(links_.begin(), links_.end(), [&](const JointLink& other) { return other.joint == names[n]; });
    if (link == links_.end())
    {
      if (model_.find(names[n]) != nullptr)
        continue;
      reason = "the robot has no joint '" + names[n] + "'; it has " + model_.movableNames();
      return std::nullopt;
    }
    std::optional<double>& value = assigned[static_cast<std::size_t>(link - links_.begin())];
    if (value)
    {
      reason = "joint '" + names[n] + "' is repeated";
      return std::nullopt;
    }
    value = values[n];
    any = true;
  }
  if (!any)
  {
    reason = "no value of a joint that moves an instrument";
    return std::nullopt;
  }
  return assigned;
}

void RobotControl::advanceTo(double time)
{
  arbiter_.advance(time - time_);
  time_ = time;
}

bool RobotControl::isReady(std::size_t instrument, CommandKind kind, std::string& reason) const
{
  const drive::ControlState& state = states_[instrument];
  const bool is_enabled = state.state == OperatingState::kEnabled;
  if (is_enabled && (state.is_homed || !isAbsolute(kind)))
    return true;
  reason = "'" + instruments_[instrument].name + "' is " + (is_enabled ? "not homed" : drive::nameOf(state.state));
  return false;
}

CommandVerdict RobotControl::examineLimits(std::size_t link, CommandKind kind, double& value, std::string& reason,
                                           bool& clamped) const
{
  const Joint& joint = *model_.find(links_[link].joint);
  const PlayAxis& axis = channels_[instrument_of_[link]].axes[indexOf(links_[link].motion)];
  std::optional<drive::Interval> permitted = joint.range;
  double origin = 0.0;  // of a relative command
  if (isByRate(kind))
  {
    const std::optional<double>& most = kind == CommandKind::kServoVelocity ? joint.speed : joint.effort;
    permitted = most ? std::optional<drive::Interval>({-*most, *most}) : std::nullopt;
  }
  else if (isRelative(kind))
    origin = links_[link].toPosition(
        kind == CommandKind::kServoRelative ? axis.driving : drivingAfterPlay(axis.driving, axis.setpoint, play(axis)));
  if (!permitted)
    return CommandVerdict::kAccepted;
  const double slack = kRounding * std::max(std::abs(permitted->low), std::abs(permitted->high));
  const double wanted = origin + value;
  if (wanted >= permitted->low - slack && wanted <= permitted->high + slack)
    return CommandVerdict::kAccepted;
  if (instruments_[instrument_of_[link]].beyond == drive::BeyondLimit::kClamp)
  {
    clamped = true;
    value = permitted->nearest(wanted) - origin;
    return CommandVerdict::kAccepted;
  }
  reason = "joint '" + joint.name + "': " + shortNumber(wanted) + " is beyond the limits " +
           shortNumber(permitted->low) + " to " + shortNumber(permitted->high) + " of the URDF";
  return CommandVerdict::kOutOfRange;
}

CommandVerdict RobotControl::examine(const std::string& client, CommandKind kind, Values& values, std::string& reason,
                                     bool& clamped) const
{
  if (arbiter_.isDrivenByAnother(client, state().is_busy))
  {
    reason = arbiter_.foreignReason();
    return CommandVerdict::kForeign;
  }
  for (std::size_t link = 0; link < links_.size(); ++link)
  {
    if (!values[link])
      continue;
    if (!isReady(instrument_of_[link], kind, reason))
      return CommandVerdict::kNotEnabled;
    if (!std::isfinite(*values[link]))
    {
      reason = "joint '" + links_[link].joint + "': not finite";
      return CommandVerdict::kNotFinite;
    }
    if (isByRate(kind) && links_[link].motion == Motion::kPressure && *values[link] != 0.0)
    {
      reason = "joint '" + links_[link].joint + "': a pressure changes by positions only";
      return CommandVerdict::kMalformed;
    }
    const CommandVerdict verdict = examineLimits(link, kind, *values[link], reason, clamped);
    if (verdict != CommandVerdict::kAccepted)
      return verdict;
  }
  return CommandVerdict::kAccepted;
}

/** Command to one instrument.
 *  @param channel of the instrument, with the sides of its plays after the command
 *  @return none if the values concern no joint of the instrument, or if a force lacks that of the insertion */
std::optional<InstrumentCommand> RobotControl::convert(std::size_t instrument, CommandKind kind, const Values& values,
                                                       Channel& channel) const
{
  std::array<std::optional<double>, 3> motions;
  bool any = false;
  for (std::size_t k = 0; k < 3; ++k)
  {
    PlayAxis& axis = channel.axes[k];
    axis.rate = 0.0;
    if (!axis.link || !values[*axis.link])
      continue;
    motions[k] = axis.command(links_[*axis.link], kind, *values[*axis.link]);
    any = true;
  }
  if (!any || (kind == CommandKind::kServoForce && !motions[0]))
    return std::nullopt;
  channel.kind = kind;
  const auto held = [kind](const PlayAxis& axis)
  {
    return kind == CommandKind::kServoPosition ? axis.driven : kind == CommandKind::kMovePosition ? axis.setpoint : 0.0;
  };
  if (motions[2] && !motions[1])  // an instrument takes a pressure after a rotation only
    motions[1] = held(channel.axes[1]);
  drive::JointCommand command{kind, motions[0].value_or(held(channel.axes[0])), motions[1], motions[2]};
  if (isByRate(kind))
    command.pressure.reset();
  return InstrumentCommand{instrument, command};
}

RobotAnswer RobotControl::reject(const std::string& client, CommandKind kind, CommandVerdict verdict,
                                 const std::string& reason)
{
  return {verdict, arbiter_.reject(verdict, drive::nameOf(kind), client, reason), {}};
}

RobotAnswer RobotControl::command(const std::string& client, CommandKind kind, const std::vector<std::string>& names,
                                  const std::vector<double>& values, double time)
{
  advanceTo(time);
  std::string reason;
  std::optional<Values> assigned = assign(names, values, reason);
  if (!assigned)
    return reject(client, kind, CommandVerdict::kMalformed, reason);
  bool clamped = false;
  const CommandVerdict verdict = examine(client, kind, *assigned, reason, clamped);
  if (verdict != CommandVerdict::kAccepted)
    return reject(client, kind, verdict, reason);
  std::vector<Channel> channels = channels_;
  RobotAnswer answer;
  for (std::size_t k = 0; k < channels.size(); ++k)
  {
    const bool concerned = std::any_of(channels[k].axes.begin(), channels[k].axes.end(),
                                       [&](const PlayAxis& axis) { return axis.link && (*assigned)[*axis.link]; });
    if (!concerned)
      continue;
    const std::optional<InstrumentCommand> converted = convert(k, kind, *assigned, channels[k]);
    if (!converted)
      return reject(client, kind, CommandVerdict::kMalformed,
                    "a torque of '" + instruments_[k].name + "' needs the force of its insertion too");
    channels[k].commanded_at = time;
    answer.commands.push_back(*converted);
  }
  channels_ = std::move(channels);
  // Joints move through their play before the instrument does.
  for (InstrumentCommand& command : answer.commands)
    if (kind == CommandKind::kServoVelocity)
      command = *rates(command.instrument);
  const bool is_move = kind == CommandKind::kMovePosition || kind == CommandKind::kMoveRelative;
  for (const InstrumentCommand& command : answer.commands)  // until the instrument publishes its state
    states_[command.instrument].is_busy = states_[command.instrument].is_busy || is_move;
  arbiter_.countClamped(clamped);
  arbiter_.accept(client);
  return answer;
}

std::string RobotControl::stateCommand(const std::string& client, const std::string& word, double time)
{
  advanceTo(time);
  if (!arbiter_.permits(client, word, state().is_busy))
    return arbiter_.lastRefusal();
  if (word == "disable")
    arbiter_.release();
  else if (word == "hold" || word == "free")
  {
    followInstruments(time);
    arbiter_.take(client);
  }
  return "";
}

/** Joints without a command of their own, which follow the instruments. */
void RobotControl::followInstruments(double time)
{
  for (Channel& channel : channels_)
  {
    channel.kind = CommandKind::kServoVelocity;
    channel.commanded_at = time;
    for (PlayAxis& axis : channel.axes)
      axis.rate = 0.0;
  }
}

/** Velocities of an instrument whose joints use up their play first: zero for joints within it. */
std::optional<InstrumentCommand> RobotControl::rates(std::size_t instrument) const
{
  const Channel& channel = channels_[instrument];
  const auto rate = [](const PlayAxis& axis) { return axis.engaged ? axis.rate : 0.0; };
  const PlayAxis& rotation = channel.axes[1];
  return InstrumentCommand{instrument,
                           {CommandKind::kServoVelocity, rate(channel.axes[0]),
                            rotation.link ? std::optional<double>(rate(rotation)) : std::nullopt, std::nullopt}};
}

std::optional<InstrumentCommand> RobotControl::follow(std::size_t instrument, const Motions& setpoint, double time)
{
  advanceTo(time);
  Channel& channel = channels_[instrument];
  const double dt = std::clamp(time - channel.followed_at, 0.0, instruments_[instrument].time_out);
  const double silence = time - channel.commanded_at;
  const bool is_over = silence < 0.0 || silence >= instruments_[instrument].time_out;
  channel.followed_at = time;
  bool has_engaged = false;
  for (std::size_t k = 0; k < 3; ++k)
  {
    PlayAxis& axis = channel.axes[k];
    has_engaged = axis.follow(setpoint[k], channel.kind, is_over, dt, play(axis)) || has_engaged;
  }
  return has_engaged && channel.kind == CommandKind::kServoVelocity ? rates(instrument) : std::nullopt;
}

drive::ControlState RobotControl::state() const
{
  drive::ControlState worst;
  for (std::size_t k = 0; k < states_.size(); ++k)
  {
    const drive::ControlState& state = states_[k];
    worst.is_homed = worst.is_homed && state.is_homed;
    worst.is_busy = worst.is_busy || state.is_busy;
    const bool is_warned = worst.reason.empty() && !state.reason.empty() && worst.state == OperatingState::kEnabled;
    const bool is_worse = state.state != worst.state && drive::worse(state.state, worst.state) == state.state;
    if (!is_worse && !is_warned)
      continue;
    worst.state = state.state;
    worst.reason = instruments_[k].name +
                   (state.reason.empty() ? std::string(" is ") + drive::nameOf(state.state) : ": " + state.reason);
  }
  return worst;
}

double RobotControl::position(std::size_t link, double motion) const
{
  const PlayAxis& axis = channels_[instrument_of_[link]].axes[indexOf(links_[link].motion)];
  return links_[link].toPosition(drivingAfterPlay(axis.driving, motion, links_[link].backlash));
}

std::vector<double> RobotControl::allJoints(const std::vector<double>& linked, bool positions) const
{
  std::vector<double> all;
  for (const Joint& joint : model_.joints)
  {
    if (!joint.isMovable())
      continue;
    const auto link =
        std::find_if(links_.begin(), links_.end(), [&](const JointLink& other) { return other.joint == joint.name; });
    if (link != links_.end())
      all.push_back(linked[static_cast<std::size_t>(link - links_.begin())]);
    else
      all.push_back(positions && joint.range ? joint.range->nearest(0.0) : 0.0);
  }
  followMimics(model_, all, positions);
  return all;
}

std::vector<std::string> RobotControl::allNames() const
{
  std::vector<std::string> names;
  for (const Joint& joint : model_.joints)
    if (joint.isMovable())
      names.push_back(joint.name);
  return names;
}

}  // namespace endovascular_sim::robot
