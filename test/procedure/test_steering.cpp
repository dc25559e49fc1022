#include "procedure/steering.h"

#include <gtest/gtest.h>

#include <cmath>

#include "contact/detector.h"
#include "procedure/observation.h"
#include "scene/scene_vessel.h"
#include "test/procedure/procedure_fixtures.h"

namespace endovascular_sim::procedure
{
namespace
{

const TipBend kUpright{0.01, Eigen::Vector3d(0, 0, 0), Eigen::Vector3d::UnitZ()};

TEST(Steering, TurnsRightHandedAboutTheShaft)
{
  const Eigen::Vector3d tip(0.005, 0, 0.008);
  EXPECT_NEAR(turnTowards(kUpright, tip, {0, 0.01, 0.01}), M_PI / 2.0, 1e-12);
  EXPECT_NEAR(turnTowards(kUpright, tip, {0, -0.01, 0.01}), -M_PI / 2.0, 1e-12);
  EXPECT_NEAR(turnTowards(kUpright, tip, {0.02, 0, 0.03}), 0.0, 1e-12);
  EXPECT_NEAR(std::abs(turnTowards(kUpright, tip, {-0.02, 0, 0.03})), M_PI, 1e-12);
}

TEST(Steering, LeavesAStraightTipAndAStraightPathAlone)
{
  EXPECT_EQ(turnTowards(kUpright, {0.001, 0, 0.01}, {0, 0.01, 0.01}), 0.0);
  EXPECT_EQ(turnTowards(kUpright, {0.005, 0, 0.008}, {0, 0.001, 0.01}), 0.0);
}

TEST(Steering, TheBendEndsBehindTheForemostCurve)
{
  const scene::Scene scene = sceneWith("    - {advance: wire, until: {insertion: 0.1}}\n");
  const instrument::Instrument& wire = scene.instruments[0].instrument;
  const instrument::Instrument& catheter = scene.instruments[1].instrument;
  EXPECT_NEAR(bentLength(wire), 3e-3 * M_PI, 1.5e-3);       // J of 3 mm
  EXPECT_NEAR(bentLength(catheter), 9.42e-3 + 8e-3, 1e-3);  // primary curve and tip of a Judkins catheter
  EXPECT_EQ(bentLength(instrument::Instrument()), 0.0);
}

TEST(Steering, APositiveRotationOfTheHandleTurnsTheBendRightHanded)
{
  const scene::Scene scene = scene::parseScene(
      "vessel: {friction: 0.05, tube: {radius: 0.01, pieces: [{length: 0.2}]}}\n"
      "instrument: {use: guidewire_014_workhorse}\n"
      "introducer: true\n"
      "sampling: {kind: adaptive, max_edge: 4.0e-3, turn_per_edge: 0.1}\n"
      "drive: {initial_insertion: 0.05}\n",
      "test scene");
  const vessel::Vessel vessel = scene::buildVessel(*scene.vessel, scene.entry, scene.file);
  const scene::EntryPose entry = scene::resolveEntry(scene.entry, vessel, scene.file);
  contact::Detector wall(vessel.mesh, scene::wallLaw(*scene.vessel));
  simulation::Simulation simulation(scene, entry, &wall, &vessel.centreline);
  const auto run = [&simulation](double rotation)
  {
    for (int k = 0; k < 400; ++k)
      simulation.stepAll({{0.05, rotation * std::min(1.0, (k + 1) / 200.0), 0.0}});
  };
  run(0.0);
  const InstrumentView before = observe(scene, simulation).instruments[0];
  run(0.8);
  const InstrumentView after = observe(scene, simulation).instruments[0];
  EXPECT_NEAR(turnTowards(before.bend, before.tip, after.tip), 0.8, 0.2);
}

/** Bent tip of 8 mm that turns with the handle, on the axis of the trunk. */
void bend(Observation& observation)
{
  InstrumentView& view = observation.instruments[0];
  const double rotation = view.hand.rotation;
  view.bend = {8e-3, Eigen::Vector3d(0, 0, view.hand.insertion - 6e-3), Eigen::Vector3d::UnitZ()};
  view.tip = Eigen::Vector3d(4e-3 * std::cos(rotation), 4e-3 * std::sin(rotation), view.hand.insertion);
}

TEST(Steering, TheOperatorTurnsTheTipAtTheJunctionOfItsGoalOnly)
{
  const scene::Scene scene =
      sceneWith("    - {advance: wire, until: {tip_in: goal, beyond: 0.01}, speed: 0.02, steer: true}\n");
  PlainWorld world(scene);
  world.disturbance = bend;
  while (world.hand(0).insertion < 0.125)
    world.run(0.1);
  EXPECT_EQ(world.hand(0).rotation, 0.0) << "the path goes straight on past the side branch";
  while (world.hand(0).insertion < 0.148 && world.time < 60.0)
    world.run(0.1);
  EXPECT_LT(std::cos(world.hand(0).rotation), -0.8) << "the goal lies opposite to the bend";
}

TEST(Steering, AStepWithoutItDoesNotTurn)
{
  const scene::Scene scene = sceneWith("    - {advance: wire, until: {tip_in: goal, beyond: 0.01}, speed: 0.02}\n");
  PlainWorld world(scene);
  world.disturbance = bend;
  world.run(7.0);
  EXPECT_EQ(world.hand(0).rotation, 0.0);
}

}  // namespace
}  // namespace endovascular_sim::procedure
