#include "nodes/session/recorded_simulation.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/archive.h"
#include "common/error.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/ros_names.h"
#include "scene/scene_file.h"
#include "scene/scene_vessel.h"

namespace endovascular_sim::nodes
{
namespace
{

vessel::Vessel recordedVessel(const SessionBag& recording, const std::string& file)
{
  for (const auto& [present, topic] : {std::pair(recording.mesh != nullptr, names::kVesselMesh),
                                       std::pair(recording.centreline != nullptr, names::kVesselCentreline)})
    if (!present)
      throw InputError(file, topic,
                       "missing, but the scene has a vessel; use a bag that holds the session from its start" +
                           (recording.damage.empty() ? std::string() : "; the bag is damaged: " + recording.damage));
  try
  {
    vessel::Vessel vessel;
    vessel.mesh = fromMessage(*recording.mesh);
    vessel.centreline = fromMessage(*recording.centreline);
    vessel.lesions = lesionsFromMessage(*recording.centreline);
    return vessel;
  }
  catch (const InputError& error)
  {
    throw InputError(file, "", std::string(error.what()) + ": the bag is damaged; use a copy that is intact");
  }
}

bool areFinite(const std::vector<double>& values)
{
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

}  // namespace

RecordedSimulation::RecordedSimulation(const SessionBag& recording, const std::string& file)
  : file_(file), scene_(scene::parseRecordedScene(recording.info.scene_yaml, file))
{
  if (scene_.vessel)
    vessel_ = recordedVessel(recording, file);
  entry_ = scene_.vessel ? scene::resolveEntry(scene_.entry, vessel_, file) : scene::resolveEntry(scene_.entry, file);
  if (scene_.vessel)
  {
    detector_ = std::make_unique<contact::Detector>(vessel_.mesh, scene::wallLaw(*scene_.vessel));
    wall_ = simulation::makeLocalDeformableWall(scene_, vessel_, *detector_);
    contacts_ = std::make_unique<simulation::ReplayContactSource>(*detector_);
  }
  simulation_.emplace(scene_, entry_, contacts_.get(), &vessel_.centreline, wall_.get());
  if (!recording.state.empty())
    loadState(recording);
}

/** @throws InputError when the state is damaged, or of another version */
void RecordedSimulation::loadState(const SessionBag& recording)
{
  std::istringstream stream(recording.state);
  // The commands are those of the recording: the states of operator and drives are not needed.
  simulation_->load(stream, recording.mesh ? recording.mesh->content_hash : 0, file_ + ": " + names::kSimulationRun,
                    [](Archive& archive) { archive.skipRest(); });
}

void RecordedSimulation::setCommands(const DriveApplied& applied)
{
  const std::size_t size = scene_.instruments.size();
  const bool is_complete =
      applied.insertion.size() == size && applied.rotation.size() == size && applied.pressure.size() == size;
  if (!is_complete || !areFinite(applied.insertion) || !areFinite(applied.rotation) || !areFinite(applied.pressure))
    throw InputError(file_, names::kDriveApplied,
                     "step " + std::to_string(applied.step) + " does not hold a finite command for each of the " +
                         std::to_string(size) + " instruments: the bag is damaged; use a copy that is intact");
  commands_.clear();
  for (std::size_t k = 0; k < size; ++k)
  {
    if (applied.pressure[k] != 0.0 && !scene_.instruments[k].instrument.balloon)
      throw InputError(file_, names::kDriveApplied,
                       "step " + std::to_string(applied.step) +
                           " holds a pressure for an instrument without a balloon: "
                           "the bag is damaged; use a copy that is intact");
    commands_.push_back({applied.insertion[k], applied.rotation[k], applied.pressure[k]});
  }
}

void RecordedSimulation::step(const DriveApplied& applied)
{
  setCommands(applied);
  if (contacts_)
    contacts_->setFirstStalePass(applied.first_stale_pass);
  simulation_->stepAll(commands_);
}

ReplayOutcome replay(const SessionBag& recording, RecordedSimulation& session, bool keep_going,
                     const std::function<void()>& after)
{
  const simulation::Simulation& simulation = session.simulation();
  ReplayOutcome outcome;
  outcome.steps = std::max(recording.recorded_steps.value_or(0), recording.steps.rbegin()->first + 1);
  outcome.steps -= std::min(outcome.steps, recording.first_step);
  outcome.incomplete = incompleteness(recording);
  for (const auto& [step, applied] : recording.steps)
  {
    if (step != simulation.steps())
    {
      outcome.incomplete = "step " + std::to_string(simulation.steps()) + " is missing; " + outcome.incomplete;
      return outcome;
    }
    session.step(*applied);
    ++outcome.compared;
    if (after)
      after();
    if (simulation.stateHash() == applied->state_hash)
      continue;
    if (outcome.different++ == 0)
    {
      outcome.first_different = step;
      outcome.recorded_hash = applied->state_hash;
      outcome.computed_hash = simulation.stateHash();
    }
    if (!keep_going)
      return outcome;
  }
  return outcome;
}

}  // namespace endovascular_sim::nodes
