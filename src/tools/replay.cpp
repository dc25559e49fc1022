#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <vector>

#include "common/error.h"
#include "contact/detector.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/session/session_bag.h"
#include "results/step_costs_csv.h"
#include "scene/scene_file.h"
#include "simulation/local_deformable_wall.h"
#include "simulation/replay_source.h"
#include "simulation/simulation.h"
#include "tools/command_line.h"
#include "tools/tool_output.h"

namespace
{

using namespace endovascular_sim;  // NOLINT: a program's main file
using Clock = std::chrono::steady_clock;

/** Simulation of a recorded session, with the vessel of the recording. */
class RecordedSimulation
{
public:
  RecordedSimulation(const nodes::SessionBag& recording, const std::string& file)
    : scene_(scene::parseRecordedScene(recording.info.scene_yaml, file))
  {
    vessel::Vessel vessel;
    if (scene_.vessel)
      vessel = recordedVessel(recording, file);
    const scene::EntryPose entry =
        scene_.vessel ? scene::resolveEntry(scene_.entry, vessel, file) : scene::resolveEntry(scene_.entry, file);
    if (scene_.vessel)
    {
      detector_ = std::make_unique<contact::Detector>(vessel.mesh, scene::wallLaw(*scene_.vessel));
      wall_ = simulation::makeLocalDeformableWall(scene_, vessel, *detector_);
      contacts_ = std::make_unique<simulation::ReplayContactSource>(*detector_);
    }
    simulation_.emplace(scene_, entry, contacts_.get(), &vessel.centreline, wall_.get());
  }

  const simulation::Simulation& simulation() const { return *simulation_; }

  /** Simulates the next step with its recorded input. */
  void step(const DriveApplied& applied)
  {
    if (contacts_)
      contacts_->setFirstStalePass(applied.first_stale_pass);
    commands_.clear();
    for (std::size_t k = 0; k < applied.insertion.size(); ++k)
      commands_.push_back({applied.insertion[k], applied.rotation.at(k), applied.pressure.at(k)});
    simulation_->stepAll(commands_);
  }

private:
  static vessel::Vessel recordedVessel(const nodes::SessionBag& recording, const std::string& file)
  {
    if (!recording.mesh || !recording.centreline)
      throw InputError(file, nodes::names::kVesselMesh, "missing, but the scene has a vessel");
    vessel::Vessel vessel;
    vessel.mesh = nodes::fromMessage(*recording.mesh);
    vessel.centreline = nodes::fromMessage(*recording.centreline);
    if (vessel.mesh.hash() != recording.mesh->content_hash)
      throw InputError(file, nodes::names::kVesselMesh, "does not match its content hash: the bag is damaged");
    return vessel;
  }

  scene::Scene scene_;
  std::unique_ptr<contact::Detector> detector_;                ///< null without a vessel
  std::unique_ptr<simulation::ReplayContactSource> contacts_;  ///< null without a vessel
  std::unique_ptr<simulation::LocalDeformableWall> wall_;      ///< null without a balloon
  std::optional<simulation::Simulation> simulation_;
  std::vector<simulation::HandCommand> commands_;
};

int replay(const std::string& file, bool keep_going, const std::string& costs_file)
{
  std::optional<results::StepCostsFile> costs;
  if (!costs_file.empty())
    costs.emplace(costs_file);
  const nodes::SessionBag recording = nodes::readSessionBag(file);
  RecordedSimulation session(recording, file);
  const simulation::Simulation& simulation = session.simulation();
  std::uint64_t different = 0;
  std::uint64_t last = recording.steps.rbegin()->first;
  for (const auto& [step, applied] : recording.steps)
  {
    if (step != simulation.steps())
    {
      std::cerr << "replay: step " << simulation.steps() << " is missing in " << file << "\n";
      return 1;
    }
    const Clock::time_point before = Clock::now();
    session.step(*applied);
    if (costs)
      costs->add(simulation, std::chrono::duration<double>(Clock::now() - before).count());
    if (simulation.stateHash() != applied->state_hash)
    {
      if (different++ == 0)
        std::fprintf(stderr, "replay: step %lu differs: recorded %s, computed %s\n", static_cast<unsigned long>(step),
                     Hash64::toHex(applied->state_hash).c_str(), Hash64::toHex(simulation.stateHash()).c_str());
      if (!keep_going)
        return 1;
    }
    if (step % 1000 == 0)
      std::fprintf(stderr, "\r%3.0f %% ", 100.0 * static_cast<double>(step) / static_cast<double>(last + 1));
  }
  std::fprintf(stderr, "\r");
  if (costs)
    tools::requireWritten(costs->flush(), costs_file);
  std::printf("%lu steps, %lu different, trajectory %s\n", static_cast<unsigned long>(simulation.steps()),
              static_cast<unsigned long>(different), Hash64::toHex(simulation.trajectoryHash()).c_str());
  return different == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv)
{
  std::string file;
  std::string costs;
  bool keep_going = false;
  tools::CommandLine line(
      "replay",
      "Simulates a recorded session again from its inputs and compares every step with the recording, bit for bit.",
      "The scene, the vessel and the inputs of every step come from the bag. To view a session without computing it "
      "again: "
      "roslaunch endovascular_sim replay.launch bag:=SESSION.bag\n"
      "Exit code: 0 all steps are equal; 1 a step differs or is missing, or the bag cannot be used; 2 wrong "
      "arguments.");
  line.argument("SESSION.bag", file, "bag of the session node");
  line.flag("--keep-going", keep_going, "counts all steps that differ instead of ending at the first one");
  line.option("--costs", costs, "FILE", "writes time, solves and contacts of every step as CSV (docs/SIMULATE.md)");
  return line.run(argc, argv, [&] { return replay(file, keep_going, costs); });
}
