#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contact/detector.h"
#include "nodes/session/session_bag.h"
#include "scene/model/scene.h"
#include "simulation/local_deformable_wall.h"
#include "simulation/replay_source.h"
#include "simulation/simulation.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::nodes
{

/** Simulation of a recorded session, with the scene and the vessel of the recording. */
class RecordedSimulation
{
public:
  /** @param file path of the bag, for errors
   *  @throws InputError when scene or vessel of the recording are damaged or missing */
  RecordedSimulation(const SessionBag& recording, const std::string& file);

  const scene::Scene& scene() const { return scene_; }
  const vessel::Vessel& vessel() const { return vessel_; }  ///< initial vessel; empty without one
  const scene::EntryPose& entry() const { return entry_; }
  const simulation::LocalDeformableWall* wall() const { return wall_.get(); }  ///< null without a balloon
  const simulation::Simulation& simulation() const { return *simulation_; }

  /** Simulates the next step with its recorded input.
   *  @throws InputError when the input does not match the instruments of the scene */
  void step(const DriveApplied& applied);

private:
  void setCommands(const DriveApplied& applied);
  void loadState(const SessionBag& recording);

  std::string file_;
  scene::Scene scene_;
  vessel::Vessel vessel_;
  scene::EntryPose entry_;
  std::unique_ptr<contact::Detector> detector_;                ///< null without a vessel
  std::unique_ptr<simulation::ReplayContactSource> contacts_;  ///< null without a vessel
  std::unique_ptr<simulation::LocalDeformableWall> wall_;      ///< null without a balloon
  std::optional<simulation::Simulation> simulation_;
  std::vector<simulation::HandCommand> commands_;
};

/** Comparison of a recorded session with its simulation. */
struct ReplayOutcome
{
  std::uint64_t compared = 0;                    ///< number of steps compared, from the first one
  std::uint64_t different = 0;                   ///< number of these steps that differ
  std::optional<std::uint64_t> first_different;  ///< first step that differs
  std::uint64_t recorded_hash = 0;               ///< state hash of that step in the recording
  std::uint64_t computed_hash = 0;               ///< state hash of that step in the simulation
  std::uint64_t steps = 0;                       ///< number of steps of the session, as far as the bag reports it
  std::string incomplete;                        ///< reason for which not every step was compared; empty if each was
};

/** Simulates the recorded steps up to the first one that is missing, and compares their state hashes.
 *  @param keep_going true: counts all steps that differ instead of ending at the first one
 *  @param after called after every step
 *  @throws InputError as RecordedSimulation::step() */
ReplayOutcome replay(const SessionBag& recording, RecordedSimulation& session, bool keep_going,
                     const std::function<void()>& after = nullptr);

}  // namespace endovascular_sim::nodes
