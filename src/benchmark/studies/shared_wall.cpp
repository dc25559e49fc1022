#include "benchmark/studies/shared_wall.h"

#include <malloc.h>

#include <functional>
#include <memory>
#include <vector>

#include "benchmark/harness/processor_time.h"
#include "contact/detector.h"
#include "scene/scene_file.h"
#include "scene/scene_vessel.h"
#include "scene/yaml/file_search.h"
#include "simulation/simulation.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr int kSimulations = 10;  // number of averaged simulations
constexpr int kSteps = 100;       // steps before memory is read, which build the neighbour lists

/** Heap memory in use [B]. */
double heapInUse()
{
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

struct Instance
{
  std::unique_ptr<contact::Detector> detector;
  std::unique_ptr<simulation::Simulation> simulation;
};

struct Cost
{
  double bytes = 0.0;
  double seconds = 0.0;  ///< processor time of the construction
};

/** Mean cost of a simulation.
 *  @param detector returns the detector of one simulation */
Cost costOf(const std::function<std::unique_ptr<contact::Detector>()>& detector, const scene::Scene& scene,
            const scene::EntryPose& entry, const vessel::Vessel& vessel, int simulations)
{
  std::vector<Instance> instances(static_cast<std::size_t>(simulations));
  const double before = heapInUse();
  const double begin = processorSeconds();
  for (Instance& instance : instances)
  {
    instance.detector = detector();
    instance.simulation =
        std::make_unique<simulation::Simulation>(scene, entry, instance.detector.get(), &vessel.centreline);
  }
  Cost cost;
  cost.seconds = (processorSeconds() - begin) / simulations;
  for (Instance& instance : instances)
    for (int step = 0; step < kSteps; ++step)
      instance.simulation->stepAll(simulation::commandsAt(scene, instance.simulation->time()));
  cost.bytes = (heapInUse() - before) / simulations;
  return cost;
}

}  // namespace

TableSpec sharedWallTable()
{
  return {"speed_shared_wall",
          "A further simulation in the same anatomy",
          {"wall model", "memory [MB]", "processor time of the construction [ms]"},
          ""};
}

Section sharedWallCost(const Progress& progress)
{
  progress(0.99, "memory of a further simulation");
  Section section({sharedWallTable()}, "speed_shared_wall");
  section.text =
      "The scene `demo`; means per simulation. Detectors with a shared wall model own their neighbour lists only. "
      "Memory is "
      "read after " +
      std::to_string(kSteps) + " steps.";
  const scene::Scene scene = scene::loadScene(scene::configFolder() + "/scenes/demo.yaml", {});
  const vessel::Vessel vessel = scene::buildVessel(*scene.vessel, scene.entry, scene.file, scene::centrelineUse(scene));
  const scene::EntryPose entry = scene::resolveStart(scene, vessel);
  const contact::WallLaw law = scene::wallLaw(*scene.vessel);
  const std::shared_ptr<const contact::WallModel> model = contact::WallModel::create(vessel.mesh);
  const auto add = [&section](const std::string& name, const Cost& cost) {
    section.table.add({name, number(1e-6 * cost.bytes), number(1e3 * cost.seconds)});
  };
  add("shared",
      costOf([&] { return std::make_unique<contact::Detector>(model, law); }, scene, entry, vessel, kSimulations));
  add("own", costOf([&] { return std::make_unique<contact::Detector>(vessel.mesh, law); }, scene, entry, vessel, 1));
  return section;
}

}  // namespace endovascular_sim::benchmark
