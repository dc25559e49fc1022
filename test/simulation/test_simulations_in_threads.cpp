#include <memory>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "contact/detector.h"
#include "scene/scene_file.h"
#include "simulation/replay_source.h"
#include "simulation/simulation.h"

// Several simulations in one process share the model of the wall, and nothing else.

namespace endovascular_sim::simulation
{
namespace
{

constexpr int kSteps = 40;
constexpr int kThreads = 3;

/** Scene and its wall: constant while threads read it. */
struct SharedTube
{
  SharedTube()
    : scene(scene::loadScene(PROJECT_DIR "/config/scenes/tube.yaml", {})),
      vessel(scene::buildVessel(*scene.vessel, scene.entry, scene.file)),
      model(contact::WallModel::create(vessel.mesh))
  {
  }

  /** Positions of the nodes after kSteps steps [m]. @param insertion of the hand in every step [m] */
  std::vector<Eigen::Vector3d> simulate(double insertion) const
  {
    contact::Detector detector(model, scene::wallLaw(*scene.vessel));
    ReplayContactSource source(detector);
    Simulation simulation(scene, scene::resolveEntry(scene.entry, vessel, scene.file), &source);
    const HandState start = simulation.hand(0);
    for (int step = 1; step <= kSteps; ++step)
      simulation.step({start.insertion + insertion * step, 0.01 * step});
    return simulation.state().position;
  }

  scene::Scene scene;
  decltype(scene::buildVessel(*scene.vessel, scene.entry, scene.file)) vessel;
  std::shared_ptr<const contact::WallModel> model;
};

TEST(SimulationsInThreads, HaveTheBitsOfSimulationsOneAfterAnother)
{
  const SharedTube tube;
  std::vector<std::vector<Eigen::Vector3d>> positions(kThreads);
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < kThreads; ++k)
    threads.emplace_back([&, k] { positions[k] = tube.simulate(1e-5 * static_cast<double>(k + 1)); });
  for (std::thread& thread : threads)
    thread.join();
  for (std::size_t k = 0; k < kThreads; ++k)
    EXPECT_EQ(positions[k], tube.simulate(1e-5 * static_cast<double>(k + 1)));
  EXPECT_NE(positions.front(), positions.back());
}

}  // namespace
}  // namespace endovascular_sim::simulation
