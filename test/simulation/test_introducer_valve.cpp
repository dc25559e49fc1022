#include <gtest/gtest.h>

#include "scene/scene_file.h"
#include "simulation/simulation.h"
#include "test/common/input_error_of.h"

namespace endovascular_sim::simulation
{
namespace
{

constexpr auto kWire = R"(
name: valve
vessel: none
entry: {direction: [1, 0, 0], up: [0, 1, 0]}
instrument:
  name: wire
  sections: [{length: 0.2, radius: 2.0e-4, material: steel, density: 7900, bending_stiffness: 5.0e-5, poisson_ratio: 0.3}]
)";
const std::string kScene = std::string(kWire) +
                           "drive: {source: script, initial_insertion: 0.02, speed: 0.02, travel: 0.1, rotation: "
                           "{points: [[0, 0], [1, 200]]}}";

Simulation simulationOf(const scene::Scene& scene)
{
  return Simulation(scene, scene::resolveEntry(scene.entry, scene.file), nullptr);
}

void run(Simulation& simulation, const scene::Scene& scene, int steps)
{
  for (int k = 1; k <= steps; ++k)
  {
    const double end = static_cast<double>(simulation.steps() + 1) * scene.solver.time_step;
    simulation.step(
        {scene.instruments.front().drive.insertionAt(end), scene.instruments.front().drive.rotationAt(end)});
  }
}

}  // namespace

TEST(IntroducerValve, AddsItsFrictionToTheForceOnTheHandAndChangesNothingElse)
{
  const scene::Scene free = scene::parseScene(kScene, "test");
  const scene::Scene held = scene::parseScene(kScene, "test", {"entry.valve_friction=0.1"});
  Simulation without = simulationOf(free);
  Simulation with = simulationOf(held);
  run(without, free, 200);
  run(with, held, 200);
  EXPECT_EQ(with.trajectoryHash(), without.trajectoryHash());
  const rod::State& state = with.state();
  // Mean surface velocity: 20 mm/s along the axis, and radius · rotation / 0.2 s about it. The script demands 200
  // rad/s, which the simulation limits.
  const double circumferential = 2e-4 * state.rotation / 0.2;
  const double along = 0.1 * 0.02 / std::hypot(0.02, circumferential);
  EXPECT_NEAR(state.hand_parts.valve, along, 1e-6);
  EXPECT_NEAR(state.hand_force - without.state().hand_force, along, 1e-6);
  EXPECT_NEAR(state.hand_torque - without.state().hand_torque, 2e-4 * along * circumferential / 0.02, 1e-9);
  EXPECT_NEAR(state.hand_parts.sum(), state.hand_force, 1e-9);
}

TEST(IntroducerValve, GivesTheSameForceAtEveryTimeStep)
{
  for (const char* step : {"2.0e-3", "1.0e-3", "0.2e-3"})
  {
    const scene::Scene scene = scene::parseScene(kScene, "test",
                                                 {"entry.valve_friction=0.1", "drive.rotation.points=[[0, 0], [1, 20]]",
                                                  std::string("solver.time_step=") + step});
    Simulation simulation = simulationOf(scene);
    run(simulation, scene, static_cast<int>(std::lround(0.2 / scene.solver.time_step)));
    EXPECT_NEAR(simulation.state().hand_parts.valve, 0.1 / std::hypot(1.0, 0.2), 1e-6) << step;
  }
}

TEST(IntroducerValve, NeedsAnIntroducer)
{
  const std::string message = inputErrorOf([&] { scene::parseScene(kWire, "test", {"entry.valve_friction=0.1"}); });
  EXPECT_NE(message.find("entry.valve_friction"), std::string::npos) << message;
}

}  // namespace endovascular_sim::simulation
