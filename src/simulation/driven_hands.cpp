#include "simulation/driven_hands.h"

#include <algorithm>
#include <utility>

#include "common/archive.h"
#include "common/error.h"
#include "scene/schema/scene_schema.h"

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kSameTime = 1e-9;  ///< tolerance of the time of a command [s]

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

const std::vector<HandCommand>& DrivenHands::next(const Simulation& simulation,
                                                  const std::vector<HandCommand>* scripted)
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
      const HandState hand = simulation.hand(static_cast<int>(k));
      const drive::HandMotion reached = simulation.reached(static_cast<int>(k));
      const drive::HandSetpoint& setpoint =
          controls_[k]->next(dt, {{reached.insertion, hand.force}, {reached.rotation, hand.torque}});
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
  : file_(file)
{
  for (drive::TimedCommand& command : commands)
  {
    const std::size_t instrument =
        commandedInstrument(scene, command.instrument, file, "line " + std::to_string(command.line));
    entries_.push_back({std::move(command), instrument});
  }
}

void CommandPlayer::play(double time, DrivenHands& hands)
{
  for (; next_ < entries_.size() && entries_[next_].command.time <= time + kSameTime; ++next_)
  {
    const drive::TimedCommand& command = entries_[next_].command;
    drive::HandControl& control = *hands.control(entries_[next_].instrument);
    const std::optional<drive::CommandKind> kind = drive::commandKind(command.word);
    const bool accepted = kind ? control.command(file_, drive::jointCommand(*kind, {}, command.values)) ==
                                     drive::CommandVerdict::kAccepted
                               : control.stateCommand(file_, command.word);
    if (!accepted)
      refusals_.push_back(file_ + ": line " + std::to_string(command.line) + ": refused: " + control.lastRefusal());
  }
}

void CommandPlayer::startFrom(double time)
{
  const auto first = std::find_if(entries_.begin(), entries_.end(),
                                  [time](const Entry& entry) { return entry.command.time >= time - kSameTime; });
  next_ = static_cast<std::size_t>(first - entries_.begin());
}

}  // namespace endovascular_sim::simulation
