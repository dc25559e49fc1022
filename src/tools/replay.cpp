#include <chrono>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <optional>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "common/error.h"
#include "contact/detector.h"
#include "endovascular_sim/DriveApplied.h"
#include "endovascular_sim/SessionInfo.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/ros_names.h"
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

/** Messages of a bag that a replay requires. */
struct Recording
{
  SessionInfoConstPtr info;
  VesselMeshConstPtr mesh;
  VesselCentrelineConstPtr centreline;
  std::map<std::uint64_t, DriveAppliedConstPtr> steps;
};

/** Topics are recorded with their full names; scenes may run in any namespace. */
bool isTopic(const std::string& topic, const std::string& name)
{
  return topic.size() > name.size() &&
         topic.compare(topic.size() - name.size() - 1, std::string::npos, "/" + name) == 0;
}

Recording read(const std::string& file)
{
  Recording recording;
  rosbag::Bag bag;
  bag.open(file, rosbag::bagmode::Read);
  for (const rosbag::MessageInstance& message : rosbag::View(bag))
  {
    if (isTopic(message.getTopic(), nodes::names::kDriveApplied))
    {
      const auto applied = message.instantiate<DriveApplied>();
      if (!applied)
        throw InputError(file, nodes::names::kDriveApplied,
                         "is that of another version of this software; replay it with the one that recorded it");
      recording.steps[applied->step] = applied;
    }
    else if (isTopic(message.getTopic(), nodes::names::kSessionInfo))
      recording.info = message.instantiate<SessionInfo>();
    else if (isTopic(message.getTopic(), nodes::names::kVesselMesh) && !recording.mesh)
      recording.mesh = message.instantiate<VesselMesh>();
    else if (isTopic(message.getTopic(), nodes::names::kVesselCentreline))
      recording.centreline = message.instantiate<VesselCentreline>();
  }
  if (!recording.info)
    throw InputError(file, nodes::names::kSessionInfo, "missing; only bags of the session node can be replayed");
  if (recording.steps.empty())
    throw InputError(file, nodes::names::kDriveApplied, "holds no step");
  return recording;
}

int replay(const std::string& file, bool keep_going, const std::string& costs_file)
{
  std::optional<results::StepCostsFile> costs;
  if (!costs_file.empty())
    costs.emplace(costs_file);
  const Recording recording = read(file);
  const scene::Scene scene = scene::parseRecordedScene(recording.info->scene_yaml, file);
  std::unique_ptr<contact::Detector> detector;
  std::unique_ptr<simulation::ReplayContactSource> contacts;
  std::unique_ptr<simulation::LocalDeformableWall> wall;
  scene::EntryPose entry;
  vessel::CentrelineTree centreline;
  if (scene.vessel)
  {
    if (!recording.mesh || !recording.centreline)
      throw InputError(file, nodes::names::kVesselMesh, "missing, but the scene has a vessel");
    vessel::Vessel vessel;
    vessel.mesh = nodes::fromMessage(*recording.mesh);
    vessel.centreline = nodes::fromMessage(*recording.centreline);
    if (vessel.mesh.hash() != recording.mesh->content_hash)
      throw InputError(file, nodes::names::kVesselMesh, "does not match its own hash: the bag is damaged");
    entry = scene::resolveEntry(scene.entry, vessel, file);
    centreline = vessel.centreline;
    detector = std::make_unique<contact::Detector>(vessel.mesh, scene::wallLaw(*scene.vessel));
    wall = simulation::makeLocalDeformableWall(scene, vessel, *detector);
    contacts = std::make_unique<simulation::ReplayContactSource>(*detector);
  }
  else
    entry = scene::resolveEntry(scene.entry, file);
  simulation::Simulation simulation(scene, entry, contacts.get(), &centreline, wall.get());
  std::vector<simulation::HandCommand> commands;
  std::uint64_t different = 0;
  std::uint64_t last = recording.steps.rbegin()->first;
  for (const auto& [step, applied] : recording.steps)
  {
    if (step != simulation.steps())
    {
      std::cerr << "replay: step " << simulation.steps() << " is missing in " << file << "\n";
      return 1;
    }
    if (contacts)
      contacts->setFirstStalePass(applied->first_stale_pass);
    commands.clear();
    for (std::size_t k = 0; k < applied->insertion.size(); ++k)
      commands.push_back({applied->insertion[k], applied->rotation.at(k), applied->pressure.at(k)});
    const Clock::time_point before = Clock::now();
    simulation.stepAll(commands);
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
