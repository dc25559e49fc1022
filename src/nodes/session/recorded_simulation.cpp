#include "nodes/session/recorded_simulation.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "common/archive.h"
#include "common/error.h"
#include "contact/detector.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/ros_names.h"
#include "scene/scene_file.h"
#include "scene/scene_vessel.h"
#include "simulation/local_deformable_wall.h"
#include "simulation/replay_source.h"

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

std::shared_ptr<const session::World> recordedWorld(const SessionBag& recording, const std::string& file)
{
  scene::Scene scene = scene::parseRecordedScene(recording.info.scene_yaml, file);
  scene.faults.clear();  // recorded commands are those after all faults
  std::optional<vessel::Vessel> vessel;
  if (scene.vessel)
    vessel = recordedVessel(recording, file);
  return session::World::make(std::move(scene), std::move(vessel));
}

}  // namespace

/** Detector of a recording, and the wall that balloons deform. */
struct RecordedSimulation::Contacts
{
  explicit Contacts(const session::World& world)
    : detector(world.wall(), scene::wallLaw(*world.scene().vessel)),
      wall(simulation::makeLocalDeformableWall(world.scene(), *world.vessel(), detector))
  {
  }

  contact::Detector detector;
  simulation::ReplayContactSource source{detector};
  std::unique_ptr<simulation::LocalDeformableWall> wall;  ///< null without a balloon
};

RecordedSimulation::RecordedSimulation(const SessionBag& recording, const std::string& file, bool results)
  : file_(file),
    controls_(recording.controls),
    motion_controls_(recording.motion_controls),
    injections_(recording.injections)
{
  const std::shared_ptr<const session::World> world = recordedWorld(recording, file);
  session::SessionSettings settings;
  settings.results = results;
  if (world->vessel() != nullptr)
  {
    contacts_ = std::make_shared<Contacts>(*world);
    settings.contacts = {contacts_, &contacts_->source};
    settings.wall = {contacts_, contacts_->wall.get()};
  }
  session_.emplace(world, settings);
  if (recording.state.empty())
    return;
  // What follows the simulation in a state has acted on the recorded commands already: drives and faults of the robot.
  const auto skip = [](Archive* archive, const simulation::Simulation&)
  {
    if (archive != nullptr)
      archive->skipRest();
  };
  session_->load(recording.state, file_ + ": " + names::kSimulationRun, skip);
}

/** Sets what is not a command in the recorded input of the next step. */
void RecordedSimulation::prepare(const DriveApplied& applied)
{
  if (contacts_)
    contacts_->source.setFirstStalePass(applied.first_stale_pass);
  const auto controls = controls_.find(simulation().steps());
  if (controls != controls_.end() && simulation().blood() != nullptr)
    session_->setFlowControls(controls->second);
  const auto motion = motion_controls_.find(simulation().steps());
  if (motion != motion_controls_.end() && simulation().motion() != nullptr)
    setMotionControls(motion->second);
  const auto injections = injections_.find(simulation().steps());
  if (injections != injections_.end() && simulation().contrast() != nullptr)
    for (const simulation::ContrastInput& input : injections->second)
      follow(input);
}

void RecordedSimulation::follow(const simulation::ContrastInput& input)
{
  if (input.injection.volume == 0.0)
    return input.refill ? session_->refillSyringe() : session_->stopInjection();
  if (const std::string refusal = session_->refusalOf(input.injection, input.refill); !refusal.empty())
    throw InputError(
        file_, names::kContrastInjection,
        "step " + std::to_string(input.step) + ": " + refusal + ": the bag is damaged; use a copy that is intact");
  session_->inject(input.injection, input.refill);
}

void RecordedSimulation::setMotionControls(motion::MotionControls controls)
{
  if (simulation().blood() != nullptr)  // the flow drives the heart
    controls.heart_rate = session_->motionControls().heart_rate;
  session_->setMotionControls(controls);
}

void RecordedSimulation::step(const DriveApplied& applied)
{
  const std::size_t size = applied.insertion.size();
  commands_.clear();
  for (std::size_t k = 0; k < size && applied.rotation.size() == size && applied.pressure.size() == size; ++k)
    commands_.push_back({applied.insertion[k], applied.rotation[k], applied.pressure[k]});
  prepare(applied);
  try
  {
    session_->step(commands_);
  }
  catch (const std::invalid_argument& error)
  {
    throw InputError(file_, names::kDriveApplied,
                     "step " + std::to_string(applied.step) + " does not fit the scene (" + error.what() +
                         "): the bag is damaged; use a copy that is intact");
  }
}

void RecordedSimulation::stepByScene(const DriveApplied& applied)
{
  prepare(applied);
  session_->step();
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
