#include <chrono>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>

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

namespace
{

using namespace endovascular_sim;  // NOLINT: a program's main file
using Clock = std::chrono::steady_clock;

constexpr auto kUsage =
    R"(Simulates a recorded session again, from its inputs, and compares every step with the recording bit for bit.

usage: replay SESSION.bag [--keep-going] [--costs FILE]

  --keep-going  counts all steps that differ instead of ending at the first
  --costs FILE  writes what every step costs here, as CSV: time, solves, contacts (docs/SIMULATE.md)
  --help        prints this

The scene, the vessel and the inputs of every step come from the bag. To look at a session instead of computing it
again: roslaunch endovascular_sim replay.launch bag:=SESSION.bag
exit code: 0 every step is equal, 1 a step differs or is missing, or the bag cannot be used, 2 wrong use
)";

int replay(const std::string& file, bool keep_going, const std::string& costs_file)
{
  std::optional<results::StepCostsFile> costs;
  if (!costs_file.empty())
    costs.emplace(costs_file);
  const nodes::SessionBag recording = nodes::readSessionBag(file);
  const scene::Scene scene = scene::parseRecordedScene(recording.info.scene_yaml, file);
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
      throw InputError(file, nodes::names::kVesselMesh, "does not match its content hash: the bag is damaged");
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
  if (costs && !costs->flush())
    throw InputError(costs_file, "", "cannot be written: is the disk full?");
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
  for (int i = 1; i < argc; ++i)
  {
    const std::string word = argv[i];
    if (word == "--help" || word == "-h")
    {
      std::cout << kUsage;
      return 0;
    }
    if (word == "--keep-going")
      keep_going = true;
    else if (word == "--costs" && i + 1 < argc)
      costs = argv[++i];
    else if (!word.empty() && word[0] != '-' && file.empty())
      file = word;
    else
    {
      std::cerr << "replay: cannot use '" << word << "'\n\n" << kUsage;
      return 2;
    }
  }
  if (file.empty())
  {
    std::cerr << "replay: a bag is needed\n\n" << kUsage;
    return 2;
  }
  try
  {
    return replay(file, keep_going, costs);
  }
  catch (const std::exception& error)
  {
    std::cerr << "replay: " << error.what() << "\n";
    return 1;
  }
}
