#include "simulation/driven_hands.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "common/archive.h"
#include "common/error.h"
#include "common/text/format.h"
#include "scene/schema/scene_schema.h"

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kSameTime = 1e-9;  ///< tolerance of the time of a command [s]
constexpr double kCalendar = 1e8;   ///< least time that is taken for a stamp of the calendar [s]

/** @param lag motion that faults of the robot have kept from the instrument */
drive::HandFeedback feedbackOf(const Simulation& simulation, int instrument, const drive::HandMotion& lag)
{
  const HandState hand = simulation.hand(instrument);
  const drive::HandMotion reached = simulation.reached(instrument);
  const drive::HandMotion slipped = simulation.slipped(instrument);
  drive::HandFeedback feedback;
  feedback.insertion = {reached.insertion + lag.insertion, hand.force, slipped.insertion + lag.insertion,
                        simulation.stops(instrument).shifted(lag.insertion)};
  feedback.rotation.reached = reached.rotation + lag.rotation;
  feedback.rotation.effort = hand.torque;
  feedback.rotation.slipped = slipped.rotation + lag.rotation;
  return feedback;
}

}  // namespace

std::size_t commandedInstrument(const scene::Scene& scene, const std::string& name, const std::string& file,
                                const std::string& where)
{
  const auto found =
      std::find_if(scene.instruments.begin(), scene.instruments.end(),
                   [&name](const scene::DrivenInstrument& driven) { return driven.instrument.name == name; });
  if (found == scene.instruments.end())
  {
    std::string names;
    for (const scene::DrivenInstrument& driven : scene.instruments)
      names += (names.empty() ? "" : ", ") + driven.instrument.name;
    throw InputError(file, where, "the scene has no instrument '" + name + "'; it has " + names);
  }
  const auto k = static_cast<std::size_t>(found - scene.instruments.begin());
  if (!isCommanded(*found))
    throw InputError(file, where,
                     "no command drives '" + name + "'; set " + scene::drivePath(scene, k) + "drive.source=topic");
  return k;
}

bool isCommanded(const scene::DrivenInstrument& driven)
{
  return driven.drive.source == scene::DriveSource::kDevice || driven.drive.source == scene::DriveSource::kTopic;
}

DrivenHands::DrivenHands(const scene::Scene& scene)
  : scene_(scene), controls_(scene.instruments.size()), next_(scene.instruments.size())
{
  for (std::size_t k = 0; k < controls_.size(); ++k)
  {
    const scene::DrivenInstrument& driven = scene.instruments[k];
    if (isCommanded(driven))
      controls_[k].emplace(drive::HandMotion{driven.drive.insertionAt(0.0), driven.drive.rotationAt(0.0)},
                           driven.limits());
  }
}

void DrivenHands::copyRejections(const DrivenHands& other)
{
  for (std::size_t k = 0; k < controls_.size(); ++k)
    if (controls_[k])
      controls_[k]->copyRejections(*other.controls_[k]);
}

drive::HandControl* DrivenHands::control(std::size_t instrument)
{
  return controls_[instrument] ? &*controls_[instrument] : nullptr;
}

const drive::HandControl* DrivenHands::control(std::size_t instrument) const
{
  return controls_[instrument] ? &*controls_[instrument] : nullptr;
}

void DrivenHands::restAt(const Simulation& simulation)
{
  for (std::size_t k = 0; k < controls_.size(); ++k)
  {
    if (!controls_[k])
      continue;
    const HandState hand = simulation.hand(static_cast<int>(k));
    controls_[k]->restAt(simulation.reached(static_cast<int>(k)), scene_.instruments[k].instrument.balloon
                                                                      ? std::optional<double>(hand.pressure)
                                                                      : std::nullopt);
  }
}

void DrivenHands::archive(Archive& archive)
{
  for (std::optional<drive::HandControl>& control : controls_)
    if (control)
      archive(*control);
}

const std::vector<drive::HandCommand>& DrivenHands::next(const Simulation& simulation,
                                                         const std::vector<drive::HandCommand>* scripted,
                                                         const robot::CommandFaults* faults)
{
  const double dt = scene_.solver.time_step;
  const double end = static_cast<double>(simulation.steps() + 1) * dt;
  if (scripted != nullptr)
    next_ = *scripted;
  for (std::size_t k = 0; k < next_.size(); ++k)
  {
    const scene::DriveScene& drive = scene_.instruments[k].drive;
    if (controls_[k])
    {
      const drive::HandMotion lag = faults != nullptr ? faults->lag(k) : drive::HandMotion();
      const drive::HandSetpoint& setpoint = controls_[k]->next(dt, feedbackOf(simulation, static_cast<int>(k), lag));
      const bool has_pressure = setpoint.pressure && scene_.instruments[k].instrument.balloon;
      next_[k] = {setpoint.motion.insertion, setpoint.motion.rotation,
                  has_pressure ? *setpoint.pressure : drive.pressureAt(end)};
    }
    else if (scripted == nullptr)
      next_[k] = {drive.insertionAt(end), drive.rotationAt(end), drive.pressureAt(end)};
  }
  return next_;
}

CommandPlayer::CommandPlayer(const scene::Scene& scene, const std::string& file,
                             std::vector<drive::TimedCommand> commands)
  : scene_(&scene), file_(file)
{
  for (drive::TimedCommand& command : commands)
  {
    const std::size_t instrument =
        commandedInstrument(scene, command.instrument, file, "line " + std::to_string(command.line));
    entries_.push_back({std::move(command), instrument});
  }
}

/** Doubt about the pauses between the rates of an instrument; empty without one. */
std::string CommandPlayer::pausesOf(std::size_t instrument, double end) const
{
  const double time_out = scene_->instruments[instrument].drive.limits.time_out;
  int pauses = 0;
  double lost = 0.0;
  double longest = 0.0;
  const drive::TimedCommand* before = nullptr;
  const auto judge = [&](double next)
  {
    const bool by_velocity = before != nullptr && before->word == drive::nameOf(drive::CommandKind::kServoVelocity);
    const bool by_rate =
        by_velocity || (before != nullptr && before->word == drive::nameOf(drive::CommandKind::kServoForce));
    const bool moves =
        by_rate && std::any_of(before->values.begin(), before->values.end(), [](double v) { return v != 0.0; });
    const double pause = before != nullptr ? std::min(next, end) - before->time : 0.0;
    if (!moves || !std::isfinite(pause) || pause <= time_out - 0.5 * scene_->solver.time_step)
      return;
    ++pauses;
    longest = std::max(longest, pause);
    lost += by_velocity ? std::abs(before->values.front()) * std::max(scene_->solver.time_step, pause - time_out) : 0.0;
  };
  for (const Entry& entry : entries_)
  {
    if (entry.instrument != instrument || entry.command.time >= end)
      continue;
    judge(entry.command.time);
    before = &entry.command;
  }
  judge(end);
  if (pauses == 0)
    return "";
  const std::string text = formatted(
      "%s: no command follows %d of the velocities and forces within drive.limits.time_out (%.3g s; pauses of up "
      "to %.3g s), so that the instrument stops; about %.1f mm of the commanded travel are lost; repeat "
      "commands faster, or raise the time-out",
      scene_->instruments[instrument].instrument.name.c_str(), pauses, time_out, longest, 1e3 * lost);
  return file_ + ": " + text;
}

std::vector<std::string> CommandPlayer::warnings(double end) const
{
  std::vector<std::string> warnings;
  const auto late = std::find_if(entries_.begin(), entries_.end(),
                                 [end](const Entry& entry) { return entry.command.time >= end - kSameTime; });
  if (late != entries_.end())
  {
    const std::string text = formatted("line %d and %td later ones lie at or after the end of the run at %g s",
                                       late->command.line, entries_.end() - late - 1, end);
    warnings.push_back(file_ + ": " + text);
  }
  for (std::size_t k = 0; k < scene_->instruments.size(); ++k)
    if (const std::string text = pausesOf(k, end); !text.empty())
      warnings.push_back(text);
  return warnings;
}

void CommandPlayer::requireCommandsBefore(double end) const
{
  if (entries_.empty())
    throw InputError(file_, "", "holds no command; give rows of time,instrument,command,values");
  if (entries_.front().command.time < std::min(end - kSameTime, kCalendar))
    return;
  const bool is_calendar = entries_.front().command.time > kCalendar;
  const std::string text = formatted(
      "the first command acts at %.10g s, after the end of the run at %g s; %s", entries_.front().command.time, end,
      is_calendar ? "times are simulated seconds from the start of the scene: subtract that of the first row"
                  : "run longer");
  throw InputError(file_, "line " + std::to_string(entries_.front().command.line), text);
}

void CommandPlayer::play(double time, DrivenHands& hands)
{
  for (; next_ < entries_.size() && entries_[next_].command.time <= time + kSameTime; ++next_)
  {
    const drive::TimedCommand& command = entries_[next_].command;
    drive::HandControl& control = *hands.control(entries_[next_].instrument);
    if (!drive::give(control, file_, command.word, {}, command.values))
      refusals_.push_back(file_ + ": line " + std::to_string(command.line) +
                          ": refused: " + control.arbiter().lastRefusal());
  }
}

void CommandPlayer::startFrom(double time)
{
  const auto first = std::find_if(entries_.begin(), entries_.end(),
                                  [time](const Entry& entry) { return entry.command.time >= time - kSameTime; });
  next_ = static_cast<std::size_t>(first - entries_.begin());
}

}  // namespace endovascular_sim::simulation
