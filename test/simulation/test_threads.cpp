#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "contact/detector.h"
#include "contact/wall_model.h"
#include "scene/scene_vessel.h"
#include "simulation/offline_session.h"

// Simulations in threads of one process. `catkin_ws/test --sanitize` also runs these under the thread sanitizer.

namespace endovascular_sim::simulation
{
namespace
{

constexpr int kThreads = 3;
constexpr int kSteps = 30;

const std::string kTube = PROJECT_DIR "/config/scenes/tube.yaml";

std::uint64_t hashOfSession()
{
  OfflineSession session(kTube, {"sampling.nodes=60"});
  for (int step = 0; step < kSteps; ++step)
    session.step();
  return session.simulation().trajectoryHash();
}

TEST(Threads, OfSeparateSessionsGiveTheTrajectoryOfOne)
{
  std::vector<std::uint64_t> hashes(kThreads);
  std::vector<std::thread> threads;
  threads.reserve(kThreads);
  for (std::uint64_t& hash : hashes)
    threads.emplace_back([&hash] { hash = hashOfSession(); });
  for (std::thread& thread : threads)
    thread.join();
  for (const std::uint64_t hash : hashes)
    EXPECT_EQ(hash, hashOfSession());
}

/** Steps of a scene on a wall; every second detector moves the wall, on a copy of its own. */
std::uint64_t hashOnSharedWall(const scene::Scene& scene, const vessel::Vessel& vessel,
                               std::shared_ptr<const contact::WallModel> model, bool moves_wall)
{
  contact::Detector detector(std::move(model), scene::wallLaw(*scene.vessel));
  const scene::EntryPose entry = scene::resolveStart(scene, vessel);
  Simulation simulation(scene, entry, &detector, &vessel.centreline, nullptr);
  for (int step = 1; step <= kSteps; ++step)
  {
    if (moves_wall && step == kSteps / 2)
      detector.moveVertices({0}, {vessel.mesh.vertices[0] + Eigen::Vector3d(1e-6, 0.0, 0.0)}, 2);
    simulation.stepAll(commandsAt(scene, step * scene.solver.time_step));
  }
  return simulation.trajectoryHash();
}

TEST(Threads, ShareOneWallUntilTheyMoveIt)
{
  const scene::Scene scene = scene::loadScene(kTube, {"sampling.nodes=60"});
  const vessel::Vessel vessel = scene::buildVessel(*scene.vessel, scene.entry, scene.file);
  std::shared_ptr<const contact::WallModel> model = contact::WallModel::create(vessel.mesh);
  std::vector<std::uint64_t> hashes(kThreads);
  std::vector<std::thread> threads;
  threads.reserve(kThreads);
  for (std::size_t k = 0; k < kThreads; ++k)
    threads.emplace_back([&, k, model] { hashes[k] = hashOnSharedWall(scene, vessel, model, k % 2 == 1); });
  model.reset();
  for (std::thread& thread : threads)
    thread.join();
  const std::shared_ptr<const contact::WallModel> untouched = contact::WallModel::create(vessel.mesh);
  for (std::size_t k = 0; k < kThreads; ++k)
    EXPECT_EQ(hashes[k], hashOnSharedWall(scene, vessel, untouched, k % 2 == 1));
}

}  // namespace
}  // namespace endovascular_sim::simulation
