#include "simulation/instrument_tip.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/scene_file.h"
#include "session/session.h"

// Rotation and material frame of an instrument's tip.

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kTimeStep = 1e-3;  // s, that of all scenes here

/** Turns the handle of the first instrument without pushing. @param speed [rad/s] */
void turnTo(Simulation& simulation, double rotation, double speed)
{
  const HandState begin = simulation.hand(0);
  const double step = speed * kTimeStep;
  const auto steps = static_cast<int>(std::ceil(std::abs(rotation - begin.rotation) / step));
  for (int k = 1; k <= steps; ++k)
  {
    drive::HandCommand command;
    command.insertion = begin.insertion;
    command.rotation = begin.rotation + (rotation - begin.rotation) * k / steps;
    std::vector<drive::HandCommand> commands(static_cast<std::size_t>(simulation.instruments()), command);
    for (int other = 1; other < simulation.instruments(); ++other)
      commands[static_cast<std::size_t>(other)] = {simulation.hand(other).insertion, simulation.hand(other).rotation};
    simulation.stepAll(commands);
  }
}

}  // namespace

TEST(InstrumentTip, OfAStraightWireInFreeSpaceTurnsWithTheHandle)
{
  session::Session session("straight_wire", {"drive.initial_insertion=0.1", "drive.travel=0.1"});
  const Simulation& simulation = session.simulation();
  const Eigen::Matrix3d begin = tipFrame(simulation, 0);
  EXPECT_EQ(tipRotation(simulation, 0), 0.0);
  EXPECT_LT((begin.col(0) - Eigen::Vector3d::UnitZ()).norm(), 1e-9) << "the direction of the introducer";
  EXPECT_LT((begin.col(1) - Eigen::Vector3d::UnitX()).norm(), 1e-9) << "up of the scene's entry";
  turnTo(session.simulation(), 0.5 * M_PI, 2.0);
  EXPECT_NEAR(tipRotation(simulation, 0), 0.5 * M_PI, 1e-12);
  const Eigen::Matrix3d end = tipFrame(simulation, 0);
  EXPECT_LT((end.col(0) - begin.col(0)).norm(), 1e-9);
  EXPECT_LT((end.col(1) - Eigen::Vector3d::UnitY()).norm(), 1e-9) << "by 90° about the tangent";
  EXPECT_LT((end.transpose() * end - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_NEAR(end.determinant(), 1.0, 1e-12);
  turnTo(session.simulation(), -5.0 * M_PI, 6.0);
  EXPECT_NEAR(tipRotation(simulation, 0), -5.0 * M_PI, 1e-12) << "full turns are counted";
}

// The tip's director follows the material: the rest curvature lies in a fixed direction of its frame.
TEST(InstrumentTip, FrameOfACurvedTipTurnsWithItsBend)
{
  session::Session session("straight_wire", {"instrument=instruments/guidewire_035_j.yaml",
                                             "drive.initial_insertion=0.08", "loads.damping=50"});
  const Simulation& simulation = session.simulation();
  const auto bendInFrame = [&simulation]() -> Eigen::Vector3d
  { return tipFrame(simulation, 0).transpose() * (pointAt(simulation, 0.08) - pointAt(simulation, 0.06)); };
  turnTo(session.simulation(), 1e-6, 2e-6);  // the released tip bends
  const Eigen::Vector3d begin = bendInFrame();
  EXPECT_GT((pointAt(simulation, 0.08) - pointAt(simulation, 0.06)).head<2>().norm(), 2e-3);
  turnTo(session.simulation(), 2.0, 2.0);
  turnTo(session.simulation(), 2.0 + 1e-6, 2e-6);  // comes to rest
  EXPECT_NEAR(tipRotation(simulation, 0), 2.0, 1e-3);
  EXPECT_LT((bendInFrame() - begin).norm(), 0.01 * begin.norm());
}

TEST(InstrumentTip, OfACurvedTipThatFrictionHoldsLagsBehindTheHandle)
{
  session::Session session(
      "tube", {"vessel.tube.pieces=[{length: 0.16}]", "instrument=instruments/guidewire_035_j.yaml",
               "vessel.friction=0.4", "drive.travel=0", "drive.initial_insertion=0.1", "sampling.nodes=300"});
  const Simulation& simulation = session.simulation();
  turnTo(session.simulation(), 0.3, 0.3);
  EXPECT_GT(simulation.hand(0).torque, 1e-5);
  EXPECT_LT(tipRotation(simulation, 0), 0.1) << "held by friction";
  turnTo(session.simulation(), 2.0 * M_PI, 2.0);
  EXPECT_GT(tipRotation(simulation, 0), 2.0) << "it slips";
  EXPECT_LT(tipRotation(simulation, 0), 2.0 * M_PI - 0.2);
}

TEST(InstrumentTip, OfEachOfTwoInstrumentsFollowsItsOwnHandle)
{
  const std::string wire =
      "{name: wire, sections: [{length: 0.3, radius: 0.4e-3, young_modulus: 2.0e9, shear_modulus: "
      "0.8e9, density: 6000, material: nitinol}]}";
  const std::string catheter =
      "{name: catheter, kind: catheter, inner_radius: 0.5e-3, sections: [{length: 0.28, radius: 0.8e-3, young_modulus: "
      "5.0e8, shear_modulus: 2.0e8, density: 1200, material: polymer}]}";
  const scene::Scene scene = scene::parseScene(
      "name: two\nvessel: none\nentry: {position: [0, 0, 0], direction: [0, 0, 1], up: [1, 0, 0]}\n"
      "sampling: {kind: uniform, nodes: 151}\ninstruments:\n"
      "  - {instrument: " +
          wire + ", drive: {source: script, initial_insertion: 0.1}}\n  - {instrument: " + catheter +
          ", drive: {source: script, initial_insertion: 0.05, initial_rotation: 0.2}}\n",
      "two.yaml");
  Simulation simulation(scene, scene::resolveEntry(scene.entry, scene.file), nullptr);
  turnTo(simulation, 0.5 * M_PI, 1.0);
  EXPECT_NEAR(tipRotation(simulation, 0), 0.5 * M_PI, 1e-9);
  EXPECT_NEAR(tipRotation(simulation, 1), 0.2, 1e-9);
  EXPECT_LT((tipFrame(simulation, 0).col(1) - Eigen::Vector3d::UnitY()).norm(), 1e-6);
  EXPECT_LT((tipFrame(simulation, 1).col(1) - Eigen::Vector3d(std::cos(0.2), std::sin(0.2), 0.0)).norm(), 1e-6);
}

}  // namespace endovascular_sim::simulation
