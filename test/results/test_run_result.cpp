#include "contact/detector.h"
#include "results/run_result.h"
#include "scene/scene_file.h"
#include "simulation/instrument_tip.h"
#include "vessel/anatomy/tube.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace endovascular_sim::results
{
namespace
{

using Json = nlohmann::json;

/** Runs a scene of the package without a vessel for some steps with an assumed step time of 50 µs. */
Json resultOf(const std::string& scene_name, int steps)
{
  const scene::Scene scene = scene::loadScene(PROJECT_DIR "/config/scenes/" + scene_name);
  simulation::Simulation simulation(scene, scene::resolveEntry(scene.entry, scene.file), nullptr);
  RunResult result(scene, 0, static_cast<std::size_t>(steps));
  for (int k = 1; k <= steps; ++k)
  {
    const double end = k * scene.solver.time_step;
    simulation.step(
        {scene.instruments.front().drive.insertionAt(end), scene.instruments.front().drive.rotationAt(end)});
    result.addStep(simulation, 50e-6);
  }
  return Json::parse(result.json(simulation));
}

TEST(RunResult, HasAllDocumentedKeys)
{
  const Json json = resultOf("straight_wire.yaml", 20);
  for (const char* key : {"steps", "dt", "nodes", "real_time_factor", "step_time_us", "worst_surface_penetration",
                          "nodes_outside", "max_strain", "inserted_length", "tip_position", "tip_tangent", "hand_force",
                          "hand_torque", "energy", "wall_forces", "trajectory_hash", "scene_hash", "mesh_hash"})
    EXPECT_TRUE(json.contains(key)) << key;
  for (const char* phase : kPhaseNames)
    for (const char* statistic : {"mean", "median", "p99", "max"})
      EXPECT_TRUE(json["step_time_us"][phase].contains(statistic)) << phase << " " << statistic;
  EXPECT_EQ(json["steps"], 20);
  EXPECT_NEAR(json["real_time_factor"].get<double>(), 20.0, 1e-9);
  EXPECT_NEAR(json["step_time_us"]["median"].get<double>(), 50.0, 1e-9);
}

TEST(RunResult, NamesPhasesThatCoverTheStep)
{
  const scene::Scene scene = scene::loadScene(PROJECT_DIR "/config/scenes/straight_wire.yaml");
  simulation::Simulation simulation(scene, scene::resolveEntry(scene.entry, scene.file), nullptr);
  std::vector<double> shares;
  for (int k = 1; k <= 200; ++k)
  {
    const auto begin = PhaseTimer::Clock::now();
    simulation.step({0.005 + 3e-5 * k, 0.001 * k});
    const double step = std::chrono::duration<double>(PhaseTimer::Clock::now() - begin).count();
    double phases = 0.0;
    for (std::size_t phase = 0; phase < kPhaseCount; ++phase)
      phases += simulation.timer().seconds(static_cast<Phase>(phase));
    EXPECT_LE(phases, step);
    shares.push_back(phases / step);
  }
  // The median: the processor may be withdrawn between the clock of a step and those of its phases.
  std::nth_element(shares.begin(), shares.begin() + 100, shares.end());
  EXPECT_GE(shares[100], 0.95);
}

TEST(RunResult, FirstInsertedNodeWithoutAnIntroducerIsTheFirstNode)
{
  for (const char* name : {"cantilever.yaml", "straight_wire.yaml"})
  {
    const scene::Scene scene = scene::loadScene(std::string(PROJECT_DIR "/config/scenes/") + name);
    const simulation::Simulation simulation(scene, scene::resolveEntry(scene.entry, scene.file), nullptr);
    EXPECT_EQ(simulation::firstInsertedNode(simulation) == 0, !scene.introducer) << name;
  }
}

TEST(RunResult, ReportsExactlyZeroForUnusedPhases)
{
  for (const char* scene : {"straight_wire.yaml", "cantilever.yaml"})
  {
    const Json json = resultOf(scene, 50);
    EXPECT_EQ(json["step_time_us"]["collision"]["max"], 0.0) << scene;
    EXPECT_EQ(json["step_time_us"]["sampling"]["max"], 0.0) << scene;
    EXPECT_EQ(json["step_time_us"]["twist"]["max"], 0.0) << scene;
    EXPECT_GT(json["step_time_us"]["solve"]["max"], 0.0) << scene;
  }
}

// The wire leaves a closed tube of 150 mm, in which its nodes stay clear of the wall for most steps.
TEST(RunResult, CountsTheNodesOutsideThatASearchForEveryNodeFinds)
{
  const scene::Scene scene = scene::loadScene(PROJECT_DIR "/config/scenes/straight_wire.yaml");
  simulation::Simulation simulation(scene, scene::resolveEntry(scene.entry, scene.file), nullptr);
  vessel::TubeShape tube;
  tube.radius = 0.004;
  tube.facet_length = 0.004;
  tube.pieces = {{0.14}};
  const contact::Detector wall(vessel::tubeMesh(tube), contact::WallLaw());
  RunResult result(scene, 0, 6000);
  int most = 0;
  for (int k = 1; k <= 6000; ++k)
  {
    simulation.step({0.005 + 3e-5 * k, 0.0});
    result.checkOutside(simulation, wall);
    int outside = 0;
    for (int i = simulation::firstInsertedNode(simulation); i < simulation.discretisation().nodes(); ++i)
      outside += wall.signedDistance(simulation.state().position[i]) < 0.0;
    most = std::max(most, outside);
    if (k % 100 != 0)
      continue;
    ASSERT_EQ(Json::parse(result.json(simulation))["nodes_outside"], most) << k;
  }
  EXPECT_GT(most, 5);
}

TEST(RunResult, ReportsMeanMedianAndTails)
{
  std::vector<double> seconds(100, 1.0);
  seconds[3] = 5.0;
  const DurationStatistics statistics = durationStatistics(seconds);
  EXPECT_NEAR(statistics.mean, 1.04, 1e-12);
  EXPECT_EQ(statistics.median, 1.0);
  EXPECT_EQ(statistics.p99, 5.0);
  EXPECT_EQ(statistics.max, 5.0);
  EXPECT_EQ(durationStatistics({}).max, 0.0);
}

}  // namespace
}  // namespace endovascular_sim::results
