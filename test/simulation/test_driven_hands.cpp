#include "simulation/driven_hands.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "common/error.h"
#include "contact/detector.h"
#include "scene/scene_file.h"

namespace endovascular_sim::simulation
{
namespace
{

using drive::CommandKind;
using drive::JointCommand;

/** Wire of 0.3 m in a tube of 0.2 m.
 *  @param drive further keys of the drive */
std::string sceneText(const std::string& drive)
{
  return "name: bench\nvessel: {tube: {radius: 2.0e-3, facet_length: 1.0e-3, pieces: [{length: 0.04}, {length: 0.03, "
         "curvature: 25.0}, {length: 0.13}]}, friction: 0.1}\nentry: {position: [0, 0, 0], direction: [0, 0, 1], up: "
         "[1, "
         "0, 0]}\nsampling: {kind: uniform, nodes: 101}\ninstrument: {name: wire, sections: [{length: 0.3, radius: "
         "0.3e-3, young_modulus: 2.0e10, shear_modulus: 0.8e10, density: 6000, material: nitinol}]}\n"
         "drive: {source: topic, initial_insertion: 0.02" +
         drive + "}\n";
}

/** Simulation of the wire, driven by commands. */
struct Bench
{
  explicit Bench(const std::string& drive = "") : scene(scene::parseScene(sceneText(drive), "bench.yaml")), hands(scene)
  {
    vessel = scene::buildVessel(*scene.vessel, scene.entry, scene.file);
    detector = std::make_unique<contact::Detector>(vessel.mesh, scene::wallLaw(*scene.vessel));
    simulation =
        std::make_unique<Simulation>(scene, scene::resolveEntry(scene.entry, vessel, scene.file), detector.get());
  }

  void send(CommandKind kind, double insertion, double rotation = 0.0)
  {
    EXPECT_EQ(hands.control(0)->command("/robot", JointCommand{kind, insertion, rotation, std::nullopt}),
              drive::CommandVerdict::kAccepted)
        << hands.control(0)->arbiter().lastRefusal();
  }

  /** Simulates; the command is repeated in every step. */
  void run(double seconds, std::optional<JointCommand> command = std::nullopt)
  {
    for (int k = 0; k < std::lround(seconds / scene.solver.time_step); ++k)
    {
      if (command)
        hands.control(0)->command("/robot", command);
      simulation->stepAll(hands.next(*simulation));
    }
  }

  double insertion() const { return simulation->hand(0).insertion; }

  scene::Scene scene;
  vessel::Vessel vessel;
  std::unique_ptr<contact::Detector> detector;
  std::unique_ptr<Simulation> simulation;
  DrivenHands hands;
};

TEST(DrivenHands, MoveAnInstrumentToAGoal)
{
  Bench bench;
  bench.send(CommandKind::kMovePosition, 0.06, 1.0);
  bench.run(0.6);
  EXPECT_NEAR(bench.insertion(), 0.06, 1e-9);
  EXPECT_NEAR(bench.simulation->hand(0).rotation, 1.0, 1e-9);
  EXPECT_FALSE(bench.hands.control(0)->state().is_busy);
}

TEST(DrivenHands, PushUntilTheInstrumentResistsWithACommandedForce)
{
  Bench bench(", limits: {force_gain: 0.5}");
  bench.run(4.0, JointCommand{CommandKind::kServoForce, 0.05, std::nullopt, std::nullopt});
  EXPECT_GT(bench.insertion(), 0.045) << "the bend of the tube resists";
  EXPECT_NEAR(bench.simulation->hand(0).force, 0.05, 0.02) << "it still creeps forward";
  const double pushed = bench.insertion();
  bench.run(2.0, JointCommand{CommandKind::kServoForce, -0.02, std::nullopt, std::nullopt});
  EXPECT_LT(bench.insertion(), pushed - 0.005) << "a negative force pulls";
}

TEST(DrivenHands, ShiftTheScaleOfFingersWhoseClientStreamsPositionsBeyondTheEnd)
{
  Bench bench(", limits: {approach_speed: 0.5}");
  bench.send(CommandKind::kServoPosition, -0.05);
  bench.run(1.0);
  EXPECT_NEAR(bench.insertion(), 0.0, 1e-6);
  EXPECT_NEAR(bench.simulation->reached(0).insertion, -0.05, 1e-6);
  bench.send(CommandKind::kServoPosition, 0.02);
  bench.run(1.0);
  EXPECT_NEAR(bench.insertion(), 0.07, 1e-3);
}

TEST(DrivenHands, KeepTheirGripWhenCommandsArriveTogether)
{
  Bench bench(", force_limit: 0.5");
  double goal = 0.02;
  for (int round = 0; round < 5; ++round)  // a stream at 40 mm/s that is delayed by 50 ms five times
  {
    for (int k = 0; k < 10; ++k)
      bench.send(CommandKind::kServoPosition, goal += 2e-4);
    bench.run(0.05);
  }
  EXPECT_NEAR(bench.insertion(), goal, 1e-9);
  EXPECT_NEAR(bench.simulation->reached(0).insertion, goal, 1e-12);
}

TEST(DrivenHands, EndAMoveAtTheStopThatItMeets)
{
  Bench bench(", limits: {approach_speed: 0.5}");
  bench.send(CommandKind::kMovePosition, -0.05);
  bench.run(1.0);
  EXPECT_NEAR(bench.insertion(), 0.0, 1e-6);
  EXPECT_NEAR(bench.hands.control(0)->setpoint().motion.insertion, 0.0, 1e-6);
  bench.send(CommandKind::kMovePosition, 0.02);
  bench.run(1.0);
  EXPECT_NEAR(bench.insertion(), 0.02, 1e-6);
}

/** Two wires in a catheter, of which the second one does not fit beside the first one.
 *  @param grip of both */
struct BlockedBench
{
  explicit BlockedBench(const std::string& grip)
    : scene(scene::parseScene(
          "name: blocked\nvessel: {tube: {radius: 2.0e-3, facet_length: 1.0e-3, pieces: [{length: 0.2}]}, friction: "
          "0.1}\nentry: "
          "{position: [0, 0, 0], direction: [0, 0, 1], up: [1, 0, 0]}\nsampling: {kind: uniform, nodes: 101}\n"
          "instruments:\n" +
              wireText("blocking", "0.03", grip) + wireText("waiting", "-0.05", grip) +
              "  - {instrument: {use: catheter_5f_jl4, name: catheter}, drive: {source: topic, initial_insertion: "
              "0.02}}\n",
          "blocked.yaml")),
      hands(scene)
  {
    vessel = scene::buildVessel(*scene.vessel, scene.entry, scene.file);
    detector = std::make_unique<contact::Detector>(vessel.mesh, scene::wallLaw(*scene.vessel));
    simulation =
        std::make_unique<Simulation>(scene, scene::resolveEntry(scene.entry, vessel, scene.file), detector.get());
  }

  static std::string wireText(const std::string& name, const std::string& insertion, const std::string& grip)
  {
    return "  - {instrument: {name: " + name +
           ", sections: [{length: 0.3, radius: 0.3e-3, young_modulus: 2.0e10, shear_modulus: 0.8e10, density: 6000, "
           "material: nitinol}]}, drive: {source: topic, grip: " +
           grip + ", initial_insertion: " + insertion + "}}\n";
  }

  /** Repeats a command to an instrument in every step. @return largest insertion setpoint of the second one [m] */
  double run(double seconds, std::size_t instrument, const JointCommand& command)
  {
    double largest = -1.0;
    for (int k = 0; k < std::lround(seconds / scene.solver.time_step); ++k)
    {
      hands.control(instrument)->command("/hand", command);
      simulation->stepAll(hands.next(*simulation));
      largest = std::max(largest, hands.control(1)->setpoint().motion.insertion);
    }
    return largest;
  }

  scene::Scene scene;
  vessel::Vessel vessel;
  std::unique_ptr<contact::Detector> detector;
  std::unique_ptr<Simulation> simulation;
  DrivenHands hands;
};

/** An instrument that is pushed against one that blocks it is as usable afterwards as one that has rested. */
TEST(DrivenHands, KeepTheSetpointOfABlockedInstrumentAtItsStop)
{
  for (const char* grip : {"fingers", "chuck"})
    for (const JointCommand& push : {JointCommand{CommandKind::kServoVelocity, 0.3, std::nullopt, std::nullopt},
                                     JointCommand{CommandKind::kServoForce, 0.5, std::nullopt, std::nullopt},
                                     JointCommand{CommandKind::kServoRelative, 3e-4, std::nullopt, std::nullopt}})
    {
      SCOPED_TRACE(std::string(grip) + " " + drive::nameOf(push.kind));
      BlockedBench bench(grip);
      const double outside = bench.simulation->hand(1).insertion;
      EXPECT_NEAR(bench.run(1.5, 1, push), outside, 1e-6);
      EXPECT_EQ(bench.simulation->slipped(1).insertion, 0.0);
      bench.run(0.6, 0, {CommandKind::kServoVelocity, -0.2, std::nullopt, std::nullopt});
      ASSERT_TRUE(bench.simulation->isOutside(0));
      bench.run(0.5, 1, {CommandKind::kServoVelocity, 0.1, std::nullopt, std::nullopt});
      EXPECT_NEAR(bench.simulation->hand(1).insertion, outside + 0.05, 2e-3);
    }
}

/** The range of the commands is that of the instrument, however far the fingers have slipped. */
TEST(DrivenHands, ApplyTheLimitsToThePositionOfTheInstrument)
{
  Bench bench(", force_limit: 0.03, limits: {insertion: [0, 0.25]}");
  bench.run(10.0, JointCommand{CommandKind::kServoVelocity, 0.1, std::nullopt, std::nullopt});
  const double jammed = bench.insertion();
  ASSERT_LT(jammed, 0.2);
  EXPECT_GT(bench.simulation->slipped(0).insertion, 0.5) << "the fingers still push";
  bench.send(CommandKind::kMoveRelative, -0.02);
  bench.run(1.0);
  EXPECT_NEAR(bench.insertion(), jammed - 0.02, 5e-3);
  bench.run(4.0, JointCommand{CommandKind::kServoVelocity, -0.1, std::nullopt, std::nullopt});
  EXPECT_NEAR(bench.insertion(), 0.0, 1e-6);
}

TEST(DrivenHands, KeepTheScaleOfAChuckThatStopsAtTheEnd)
{
  Bench bench(", grip: chuck, limits: {approach_speed: 0.5}");
  bench.send(CommandKind::kMovePosition, -0.05);
  bench.run(1.0);
  EXPECT_NEAR(bench.insertion(), 0.0, 1e-6);
  bench.send(CommandKind::kMovePosition, 0.02);
  bench.run(1.0);
  EXPECT_NEAR(bench.insertion(), 0.02, 1e-6);
}

TEST(DrivenHands, StopAChuckAtItsForceLimitAndLetItFollowAgain)
{
  Bench bench(", grip: chuck, force_limit: 0.03, initial_rotation: 0, limits: {approach_speed: 0.2}");
  bench.send(CommandKind::kMovePosition, 0.25);
  bench.run(2.5);
  const double stopped = bench.insertion();
  EXPECT_LT(stopped, 0.2) << "the bend of the tube resists with more than the limit";
  EXPECT_LT(bench.simulation->hand(0).force, 0.06);
  EXPECT_EQ(bench.simulation->reached(0).insertion, stopped) << "nothing has slipped";
  bench.send(CommandKind::kMovePosition, 0.03);
  bench.run(2.5);
  EXPECT_NEAR(bench.insertion(), 0.03, 1e-6);
}

TEST(DrivenHands, LimitTheSpeedOfTheHandAsTheSceneSays)
{
  Bench bench(", limits: {speed: 0.05}");
  double last = bench.insertion();
  for (int k = 0; k < 300; ++k)
  {
    bench.simulation->step({0.06, 0.0, 0.0});
    EXPECT_LE(bench.insertion() - last, 0.05e-3 * (1.0 + 1e-9));
    last = bench.insertion();
  }
  EXPECT_NEAR(bench.insertion(), 0.035, 1e-4);
}

TEST(DrivenHands, GiveOneTrajectoryForOneFileOfCommands)
{
  const std::vector<drive::TimedCommand> commands = {{0.0, "wire", "enable", {}, 1},
                                                     {0.0, "wire", "move_jp", {0.05, 0.5}, 2},
                                                     {0.4, "wire", "servo_jv", {0.05}, 3},
                                                     {0.5, "wire", "servo_jf", {0.02, 1e-4}, 4},
                                                     {0.6, "wire", "servo_jr", {0.001, 0.1}, 5},
                                                     {0.65, "wire", "servo_jp", {1e300}, 6},
                                                     {0.7, "wire", "pause", {}, 7}};
  std::uint64_t hash = 0;
  for (int repetition = 0; repetition < 2; ++repetition)
  {
    Bench bench;
    CommandPlayer player(bench.scene, "commands.csv", commands);
    while (bench.simulation->steps() < 800)
    {
      player.play(bench.simulation->time(), bench.hands);
      bench.simulation->stepAll(bench.hands.next(*bench.simulation));
    }
    ASSERT_EQ(player.refusals().size(), 1U);
    EXPECT_NE(player.refusals().front().find("line 6"), std::string::npos);
    EXPECT_EQ(bench.hands.control(0)->state().state, drive::OperatingState::kPaused);
    EXPECT_TRUE(repetition == 0 || bench.simulation->trajectoryHash() == hash);
    hash = bench.simulation->trajectoryHash();
  }
}

drive::TimedCommand timed(double time, const char* word, double value)
{
  return {time, "wire", word, {value, 0.0}, 1};
}

TEST(CommandPlayer, TellsWhichVelocitiesTheTimeOutEnds)
{
  const Bench bench;
  const auto everySeconds = [&bench](double period)
  {
    std::vector<drive::TimedCommand> commands;
    for (int k = 0; k < 10; ++k)
      commands.push_back(timed(k * period, "servo_jv", 0.02));
    commands.push_back(timed(10 * period, "servo_jv", 0.0));
    commands.push_back(timed(10 * period + 5.0, "servo_jv", 0.0));
    return CommandPlayer(bench.scene, "log.csv", commands).warnings(60.0);
  };
  EXPECT_TRUE(everySeconds(0.1).empty()) << "nothing is lost while the instrument rests";
  const std::vector<std::string> warnings = everySeconds(0.25);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("log.csv: wire: no command follows 10 of"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("about 10.0 mm"), std::string::npos) << warnings[0];
  const CommandPlayer one(bench.scene, "log.csv", {timed(0.5, "servo_jv", 0.02), timed(70.0, "servo_jv", 0.02)});
  ASSERT_EQ(one.warnings(1.7).size(), 2U) << "the second row lies after the end";
  EXPECT_NE(one.warnings(1.7)[1].find("about 20.0 mm"), std::string::npos) << one.warnings(1.7)[1];
}

TEST(CommandPlayer, RefusesCommandsThatAllActAfterTheEnd)
{
  const Bench bench;
  const CommandPlayer late(bench.scene, "log.csv",
                           {timed(1.7e9, "move_jp", 0.05), timed(1.7e9 + 1.0, "move_jp", 0.03)});
  EXPECT_THROW(late.requireCommandsBefore(5.0), InputError);
  const CommandPlayer partly(bench.scene, "log.csv", {timed(4.0, "move_jp", 0.05), timed(5.0, "move_jp", 0.03)});
  EXPECT_NO_THROW(partly.requireCommandsBefore(5.0));
  ASSERT_EQ(partly.warnings(5.0).size(), 1U);
  EXPECT_NE(partly.warnings(5.0)[0].find("at or after the end"), std::string::npos);
}

TEST(DrivenHands, RefuseCommandsToAnUnknownOrAScriptedInstrument)
{
  const std::vector<drive::TimedCommand> unknown = {{0.0, "catheter", "pause", {}, 1}};
  const std::vector<drive::TimedCommand> known = {{0.0, "wire", "pause", {}, 1}};
  scene::Scene scene = scene::parseScene(sceneText(""), "bench.yaml");
  EXPECT_THROW(CommandPlayer(scene, "commands.csv", unknown), InputError);
  scene.instruments[0].drive.source = scene::DriveSource::kScript;
  EXPECT_THROW(CommandPlayer(scene, "commands.csv", known), InputError);
}

}  // namespace
}  // namespace endovascular_sim::simulation
