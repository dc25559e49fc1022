#include "procedure/operator.h"
#include "scene/scene_file.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/error.h"
#include "test/common/input_error_of.h"
#include "test/procedure/procedure_fixtures.h"

namespace endovascular_sim::procedure
{
namespace
{

TEST(Operator, ExecutesTheStepsInOrder)
{
  PlainWorld world(
      sceneWith("    - {advance: wire, until: {tip_in: trunk, beyond: 0.08}, speed: 0.04}\n"
                "    - {rotate: wire, until: {turned: 1.5}, turn_speed: 2}\n"
                "    - {wait: 0.5}\n"
                "    - {withdraw: wire, until: {insertion: 0.02}, speed: 0.05}\n"));
  world.run(10.0);
  EXPECT_EQ(world.scripted_operator.progress(), Progress::kDone);
  ASSERT_EQ(world.scripted_operator.records().size(), 4U);
  EXPECT_EQ(world.scripted_operator.records()[0].name, "advance wire until its tip is in trunk by 80.0 mm");
  for (const StepRecord& record : world.scripted_operator.records())
    EXPECT_EQ(record.outcome, Progress::kDone);
  EXPECT_NEAR(world.hand(0).insertion, 0.02, 0.01);
  EXPECT_NEAR(world.hand(0).rotation, 1.5, 0.3);
  EXPECT_EQ(world.hand(1).insertion, 0.0) << "the catheter was not moved";
}

TEST(Operator, RecordsTheViewInForceAtEachStep)
{
  PlainWorld world(
      sceneWith("    - {wait: 0.1}\n    - {wait: 0.1, view: LAO 40}\n    - {wait: 0.1}\n"
                "    - {exchange: wire, for: catheter, until: {insertion: 0.01}, view: spider}\n"));
  world.run(3.0);
  std::vector<std::string> views;
  for (const StepRecord& record : world.scripted_operator.records())
    views.push_back(record.view);
  EXPECT_EQ(views, (std::vector<std::string>{"", "LAO 40", "LAO 40", "spider", "spider"}));
}

TEST(Operator, WithdrawsIntoABranchAndToADepth)
{
  const auto tip = [](double insertion, double /*rotation*/)
  { return Eigen::Vector3d(std::max(0.0, insertion - 0.1), 0.0, std::min(insertion, 0.1)); };
  PlainWorld world(sceneWith("    - {advance: wire, until: {insertion: 0.15}, any_branch: true, speed: 0.05}\n"
                             "    - {withdraw: wire, until: {tip_in: side, beyond: 0.02}}\n"
                             "    - {wait: 1}\n"
                             "    - {withdraw: wire, until: {tip_in: trunk}}\n"),
                   tip);
  world.run(6.0);
  EXPECT_NEAR(world.hand(0).insertion, 0.1 + 0.007 + 0.02, 0.003);
  world.run(5.0);
  EXPECT_EQ(world.scripted_operator.progress(), Progress::kDone) << world.scripted_operator.failure();
  EXPECT_NEAR(world.hand(0).insertion, 0.107, 0.003);
}

TEST(Operator, ObeysItsLimitsOfSpeedAndAcceleration)
{
  PlainWorld world(sceneWith("    - {advance: wire, until: {by: 0.15}, speed: 0.5, turn_speed: 50}\n",
                             "{max_speed: 0.03, max_turn: 2, acceleration: 0.1, turn_acceleration: 5}"));
  world.run(8.0);
  double speed_before = 0.0;
  double turn_before = 0.0;
  double fastest = 0.0;
  for (std::size_t k = 1; k < world.history.size(); ++k)
  {
    const double speed = (world.history[k][0].insertion - world.history[k - 1][0].insertion) / 1e-3;
    const double turn = (world.history[k][0].rotation - world.history[k - 1][0].rotation) / 1e-3;
    EXPECT_LE(std::abs(speed), 0.03 + 1e-9);
    EXPECT_LE(std::abs(turn), 2.0 + 1e-9);
    if (k > 1)
    {
      EXPECT_LE(std::abs(speed - speed_before), 0.1 * 1e-3 + 1e-9);
      EXPECT_LE(std::abs(turn - turn_before), 5.0 * 1e-3 + 1e-9);
    }
    speed_before = speed;
    turn_before = turn;
    fastest = std::max(fastest, speed);
  }
  EXPECT_NEAR(fastest, 0.03, 1e-6) << "the limit must be active in this test";
}

TEST(Operator, ObservesAtItsReactionIntervalOnly)
{
  const PlainWorld world(sceneWith("    - {wait: 1}\n", "{reaction: 0.05}"));
  EXPECT_TRUE(world.scripted_operator.observesBefore(0));
  EXPECT_FALSE(world.scripted_operator.observesBefore(49));
  EXPECT_TRUE(world.scripted_operator.observesBefore(50));
}

TEST(Operator, IsDeterministic)
{
  const std::string steps = "    - {advance: wire, until: {tip_in: trunk, beyond: 0.12}, turn_speed: 1}\n";
  PlainWorld one(sceneWith(steps));
  PlainWorld other(sceneWith(steps));
  one.run(5.0);
  other.run(5.0);
  for (std::size_t k = 0; k < one.history.size(); ++k)
  {
    ASSERT_EQ(one.history[k][0].insertion, other.history[k][0].insertion);
    ASSERT_EQ(one.history[k][0].rotation, other.history[k][0].rotation);
  }
}

TEST(Operator, StopsPushingAtItsForceLimit)
{
  PlainWorld world(
      sceneWith("    - {advance: wire, until: {by: 0.15}, speed: 0.02}\n", "{push_force: 1.0, patience: 100}"));
  world.run(2.0);
  const double before = world.hand(0).insertion;
  EXPECT_GT(before, 0.02);
  world.force = 1.2;
  world.run(2.0);
  EXPECT_LT(world.hand(0).insertion - before, 0.005) << "stops within one reaction interval";
  world.force = 0.3;
  world.run(1.0);
  EXPECT_GT(world.hand(0).insertion - before, 0.01) << "continues when the force has vanished";
}

TEST(Operator, PullsBackRotatesAndRetriesWithoutProgress)
{
  // The tip is stuck at 60 mm until the wire has been rotated.
  PlainWorld world(sceneWith("    - {advance: wire, until: {tip_in: trunk, beyond: 0.1}, speed: 0.02,\n"
                             "       retry: {back: 0.01, turn: 0.8, times: 5}}\n"),
                   [](double insertion, double rotation)
                   { return Eigen::Vector3d(0.0, 0.0, rotation < 1.2 ? std::min(insertion, 0.06) : insertion); });
  world.run(25.0);
  EXPECT_EQ(world.scripted_operator.progress(), Progress::kDone);
  EXPECT_EQ(world.scripted_operator.records().front().retries, 2);
  EXPECT_GE(world.hand(0).rotation, 1.2);
}

TEST(Operator, RetriesAfterPassingTheGoal)
{
  // The tip passes the ostium of the goal at 150 mm until the wire has been rotated.
  PlainWorld world(sceneWith("    - {advance: wire, until: {tip_in: goal, beyond: 0.01}, speed: 0.02,\n"
                             "       retry: {back: 0.03, turn: 0.8, times: 5, deepest: 0.17}}\n"),
                   [](double insertion, double rotation) -> Eigen::Vector3d
                   {
                     const double beyond = rotation < 1.2 ? 0.0 : std::max(0.0, insertion - 0.15);
                     return {-beyond, 0.0, insertion - beyond};
                   });
  world.run(30.0);
  EXPECT_EQ(world.scripted_operator.progress(), Progress::kDone) << world.scripted_operator.failure();
  EXPECT_EQ(world.scripted_operator.records().front().retries, 2);
}

TEST(Operator, LeavesABranchThatDoesNotLeadToItsGoal)
{
  // Without rotation the wire enters the side branch. After a rotation it stays in the trunk and enters the goal.
  const auto tip = [](double insertion, double rotation) -> Eigen::Vector3d
  {
    const double turn_off = rotation < 0.5 ? 0.1 : 0.15;
    const double side = rotation < 0.5 ? 1.0 : -1.0;
    const double beyond = std::max(0.0, insertion - turn_off);
    return {side * beyond, 0.0, std::min(insertion, turn_off)};
  };
  PlainWorld world(sceneWith("    - {advance: wire, until: {tip_in: goal, beyond: 0.01}, speed: 0.02,\n"
                             "       retry: {back: 0.005, turn: 0.8, times: 3}}\n"),
                   tip);
  world.run(30.0);
  EXPECT_EQ(world.scripted_operator.progress(), Progress::kDone) << world.scripted_operator.failure();
  EXPECT_EQ(world.scripted_operator.records().front().wrong_branches, 1);
}

/** Disturbance that displaces the support: a wire that leaves the catheter by 20 mm lifts it from the goal branch into
 *  the trunk, a given number of times. Both remain there until the catheter is advanced by 2 mm. */
struct LiftingWire
{
  int times = 1;
  bool lifted = false;
  double lifted_at = 0.0;  ///< insertion of the catheter [m]

  void operator()(Observation& observation)
  {
    InstrumentView& wire = observation.instruments[0];
    InstrumentView& catheter = observation.instruments[1];
    if (!lifted && times > 0 && wire.hand.insertion > catheter.hand.insertion + 0.02)
    {
      lifted = true;
      lifted_at = catheter.hand.insertion;
      --times;
    }
    lifted = lifted && catheter.hand.insertion < lifted_at + 0.002;
    if (!lifted)
      return;
    wire.branch_position = catheter.branch_position = {0, 0.14};
    wire.tip = catheter.tip = {0.0, 0.0, 0.14};
  }
};

/** Wire and catheter in an engagement with support. */
struct SupportedWorld : PlainWorld
{
  explicit SupportedWorld(int times)
    : PlainWorld(
          sceneWith("    - {phase: Engagement, advance: catheter, until: {tip_in: goal, beyond: 0.01}, speed: 0.01}\n"
                    "    - {advance: wire, until: {insertion: 0.15}, speed: 0.05}\n"
                    "    - {phase: Wire, advance: wire, until: {tip_in: goal, beyond: 0.045}, speed: 0.005,\n"
                    "       support: {instrument: catheter, tip_in: goal, again_from: Engagement, times: 2}}\n"),
          [](double insertion, double /*rotation*/) -> Eigen::Vector3d
          {
            const double beyond = std::max(0.0, insertion - 0.15);
            return {-beyond, 0.0, insertion - beyond};
          })
  {
    disturbance = LiftingWire{times};
  }
};

TEST(Operator, WithdrawsAndResumesFromAnEarlierPhaseAfterALossOfSupport)
{
  SupportedWorld world(1);
  world.run(80.0);
  EXPECT_EQ(world.scripted_operator.progress(), Progress::kDone) << world.scripted_operator.failure();
  std::vector<std::size_t> steps;
  for (const StepRecord& record : world.scripted_operator.records())
    steps.push_back(record.step);
  ASSERT_EQ(steps, (std::vector<std::size_t>{0, 1, 2, 0, 1, 2}));
  EXPECT_EQ(world.scripted_operator.records()[2].outcome, Progress::kSupportLost);
  EXPECT_EQ(world.scripted_operator.records()[5].outcome, Progress::kDone);
  EXPECT_EQ(world.scripted_operator.records()[4].phase, "Engagement");
  for (std::size_t k = 1; k < world.history.size(); ++k)
  {
    const double wire = world.history[k][0].insertion;
    const double catheter = world.history[k][1].insertion;
    if (catheter > 0.1 && catheter != world.history[k - 1][1].insertion)
    {
      ASSERT_LT(wire, catheter - 0.04) << "the catheter moves while the wire is inside it";
    }
  }
}

TEST(Operator, FailsAfterRepeatedLossesOfSupport)
{
  SupportedWorld world(100);
  world.run(200.0);
  EXPECT_EQ(world.scripted_operator.progress(), Progress::kFailed);
  EXPECT_NE(world.scripted_operator.failure().find("catheter has left goal repeatedly"), std::string::npos)
      << world.scripted_operator.failure();
  EXPECT_EQ(world.scripted_operator.records().size(), 9U) << "the phase was repeated twice";
}

TEST(Operator, ToleratesAShortLossOfSupport)
{
  SupportedWorld world(0);
  world.disturbance = [](Observation& observation)
  {
    if (observation.instruments[0].hand.insertion > 0.17 && std::fmod(observation.time, 2.0) < 1.0)
      observation.instruments[0].branch_position = observation.instruments[1].branch_position = {0, 0.14};
  };
  world.run(40.0);
  EXPECT_EQ(world.scripted_operator.progress(), Progress::kDone) << world.scripted_operator.failure();
  for (const StepRecord& record : world.scripted_operator.records())
    EXPECT_EQ(record.outcome, Progress::kDone);
}

TEST(Operator, NeedsNoSupportOnceTheTipIsInTheBranch)
{
  SupportedWorld world(0);
  world.disturbance = [](Observation& observation)
  {
    if (observation.instruments[0].hand.insertion > 0.18)
      observation.instruments[1].branch_position = {0, 0.14};
  };
  world.run(80.0);
  EXPECT_EQ(world.scripted_operator.progress(), Progress::kDone) << world.scripted_operator.failure();
  EXPECT_EQ(world.scripted_operator.records().size(), 3U);
}

TEST(Operator, RejectsAnInvalidSupport)
{
  const auto step = [](const std::string& support)
  {
    return "    - {phase: Engagement, advance: catheter, until: {tip_in: goal}}\n"
           "    - {phase: Wire, advance: wire, until: {tip_in: goal}, support: " +
           support + "}\n    - {phase: Later, wait: 1}\n";
  };
  EXPECT_NO_THROW(sceneWith(step("{instrument: catheter, tip_in: goal, again_from: Engagement}")));
  EXPECT_THROW(sceneWith(step("{instrument: stent, tip_in: goal, again_from: Engagement}")), InputError);
  EXPECT_THROW(sceneWith(step("{instrument: wire, tip_in: goal, again_from: Engagement}")), InputError);
  EXPECT_THROW(sceneWith(step("{instrument: catheter, tip_in: goal, again_from: Later}")), InputError);
  EXPECT_THROW(sceneWith("    - {phase: Engagement, advance: catheter, until: {tip_in: goal},\n"
                         "       support: {instrument: wire, tip_in: goal, again_from: Engagement}}\n"),
               InputError)
      << "the wire is inside the catheter";
  EXPECT_THROW(sceneWith("    - {phase: Wire, withdraw: wire, until: {outside: true},\n"
                         "       support: {instrument: catheter, tip_in: goal, again_from: Wire}}\n"),
               InputError);
  EXPECT_THROW(sceneWith(step("{instrument: catheter, tip_in: goal}")), InputError);
  EXPECT_THROW(PlainWorld(sceneWith(step("{instrument: catheter, tip_in: gaol, again_from: Engagement}"))), InputError);
}

TEST(Operator, FailureReportsStepReasonAndPositionOfTheTip)
{
  PlainWorld world(sceneWith("    - {wait: 0.1}\n"
                             "    - {advance: wire, until: {tip_in: goal}, speed: 0.02, retry: {times: 1}}\n"),
                   [](double insertion, double /*rotation*/)
                   { return Eigen::Vector3d(0.0, 0.0, std::min(insertion, 0.06)); });
  world.run(30.0);
  EXPECT_EQ(world.scripted_operator.progress(), Progress::kFailed);
  EXPECT_EQ(world.scripted_operator.failure(),
            "step 2 (advance wire until its tip is in goal): makes no progress, after 1 retries; the tip of wire is "
            "in trunk, 60.0 mm beyond its ostium, at (0.0, 0.0, 60.0) mm");
  const double rest = world.hand(0).insertion;
  world.run(5.0);
  EXPECT_NEAR(world.hand(0).insertion, rest, 1e-3) << "the operator stops";
}

TEST(Operator, FailsAfterItsTimeLimit)
{
  PlainWorld world(sceneWith("    - {advance: wire, until: {by: 0.4}, speed: 0.01, time_limit: 3}\n"));
  world.run(5.0);
  EXPECT_EQ(world.scripted_operator.progress(), Progress::kFailed);
  EXPECT_NE(world.scripted_operator.failure().find("not done within 3 s"), std::string::npos)
      << world.scripted_operator.failure();
}

TEST(Operator, ExchangeWithdrawsOneInstrumentBeforeAdvancingTheOther)
{
  PlainWorld world(
      sceneWith("    - {advance: wire, until: {by: 0.05}, speed: 0.05}\n"
                "    - {exchange: wire, for: catheter, until: {insertion: 0.03}, speed: 0.05}\n"));
  world.run(10.0);
  EXPECT_EQ(world.scripted_operator.progress(), Progress::kDone);
  for (const std::vector<drive::HandCommand>& commands : world.history)
    EXPECT_TRUE(commands[1].insertion <= 0.0 || commands[0].insertion <= -0.02)
        << commands[0].insertion << " " << commands[1].insertion;
  EXPECT_GT(world.hand(1).insertion, 0.03);
}

TEST(Operator, RejectsADeepestInsertionBelowTheGoal)
{
  EXPECT_THROW(sceneWith("    - {withdraw: wire, until: {outside: true}, retry: {deepest: 0.1}}\n"), InputError);
  EXPECT_THROW(sceneWith("    - {advance: wire, until: {insertion: 0.2}, retry: {deepest: 0.1}}\n"), InputError);
  EXPECT_NO_THROW(sceneWith("    - {advance: wire, until: {insertion: 0.2}, retry: {deepest: 0.3}}\n"));
}

TEST(Operator, RejectsAnUnknownBranch)
{
  const std::string message =
      inputErrorOf([&] { PlainWorld world(sceneWith("    - {advance: wire, until: {tip_in: gaol}}\n")); });
  EXPECT_EQ(message,
            "test scene: procedure.steps.0.until: the vessel has no branch 'gaol'; known: trunk, "
            "side, goal");
}

TEST(Operator, AcceptsBranchNamesOfTheProcedure)
{
  const scene::Scene scene = scene::parseScene(
      "vessel: {friction: 0.1, tube: {radius: 0.01, pieces: [{length: 0.3}]}}\n"
      "instrument: {use: guidewire_035_j}\ndrive: {source: procedure}\n"
      "procedure:\n  branches: [{name: left_main, at: [-0.04, 0, 0.15]}]\n"
      "  steps: [{advance: guidewire, until: {tip_in: left_main}}]\n",
      "test scene");
  const PlainWorld world(scene);
  EXPECT_EQ(world.scripted_operator.locator().find("left_main"), 2);
  EXPECT_EQ(world.scripted_operator.locator().find("goal"), 2) << "the name in the vessel remains valid";
}

TEST(Operator, ContinuesFromASavedStateBitForBit)
{
  const scene::Scene scene = sceneWith(
      "    - {advance: wire, until: {tip_in: trunk, beyond: 0.05}, speed: 0.02, turn_speed: 1}\n"
      "    - {rotate: wire, until: {turned: 3}}\n"
      "    - {withdraw: wire, until: {insertion: 0.02}}\n");
  const auto caught = [](double insertion, double rotation)
  { return Eigen::Vector3d(0.0, 0.0, rotation < 4.0 ? std::min(insertion, 0.03) : insertion); };
  for (const double at : {0.5, 3.0, 6.0, 11.0})  // while advancing, in a recovery, later
  {
    PlainWorld world(scene, caught);
    world.run(at);
    Archive saved;
    world.scripted_operator.archive(saved);
    PlainWorld other(world);
    other.scripted_operator = Operator(scene, forkedTree(), {0, 0, 0.001});
    Archive loaded(saved.bytes());
    other.scripted_operator.archive(loaded);
    EXPECT_TRUE(loaded.atEnd());
    world.run(10.0);
    other.run(10.0);
    ASSERT_EQ(world.history.size(), other.history.size());
    for (std::size_t k = 0; k < world.history.size(); ++k)
    {
      ASSERT_EQ(world.history[k][0].insertion, other.history[k][0].insertion) << at << " " << k;
      ASSERT_EQ(world.history[k][0].rotation, other.history[k][0].rotation) << at << " " << k;
    }
    EXPECT_EQ(world.scripted_operator.records().size(), other.scripted_operator.records().size());
    EXPECT_EQ(world.scripted_operator.records().back().name, other.scripted_operator.records().back().name);
    EXPECT_EQ(world.scripted_operator.records().back().retries, other.scripted_operator.records().back().retries);
  }
}

TEST(Operator, ContinuesFromAStateSavedAfterALossOfSupport)
{
  for (const double at : {28.0, 30.5, 32.0, 34.0, 38.0})
  {
    SupportedWorld world(1);
    world.run(at);
    Archive saved;
    world.scripted_operator.archive(saved);
    SupportedWorld other(world);
    other.scripted_operator = SupportedWorld(1).scripted_operator;
    Archive loaded(saved.bytes());
    other.scripted_operator.archive(loaded);
    world.run(50.0);
    other.run(50.0);
    EXPECT_EQ(world.scripted_operator.records().size(), 6U);
    ASSERT_EQ(world.history.size(), other.history.size());
    for (std::size_t k = 0; k < world.history.size(); ++k)
      for (int hand : {0, 1})
        ASSERT_EQ(world.history[k][hand].insertion, other.history[k][hand].insertion) << at << " " << k;
  }
}

TEST(Operator, RejectsASavedStateOfALongerProcedure)
{
  const std::string wait = "    - {wait: 0.1}\n";
  PlainWorld longer(sceneWith(wait + wait + wait));
  longer.run(0.35);
  Archive saved;
  longer.scripted_operator.archive(saved);
  PlainWorld shorter{sceneWith(wait)};
  Archive loaded(saved.bytes());
  EXPECT_THROW(shorter.scripted_operator.archive(loaded), ArchiveError);
}

/** A guided procedure: instruments follow the hands of a person, here the positions of the scene's profiles. */
scene::Scene guidedScene(const std::string& steps, const std::string& drive)
{
  return scene::parseScene(
      "vessel: {friction: 0.1, tube: {radius: 0.01, pieces: [{length: 0.3}]}}\n"
      "instruments:\n"
      "  - {instrument: {use: guidewire_035_j, name: wire}, drive: {source: topic, " +
          drive +
          "}}\n"
          "  - {instrument: {use: catheter_5f_jl4, name: catheter}, drive: {source: topic}}\n"
          "procedure:\n  guided: true\n  steps:\n" +
          steps,
      "test scene");
}

TEST(Operator, OfAGuidedProcedureObservesTheGoalsOfAPersonWithoutCommandsAndTimeLimit)
{
  PlainWorld world(
      guidedScene("    - {advance: wire, until: {tip_in: trunk, beyond: 0.08}, hint: Push, time_limit: 1}\n"
                  "    - {withdraw: wire, until: {insertion: 0.02}, hint: Pull}\n",
                  "insertion: {points: [[0, 0.01], [10, 0.1], [20, 0.01]]}"));
  world.run(5.0);
  EXPECT_EQ(world.scripted_operator.progress(), Progress::kRunning) << "no limit of time";
  EXPECT_NEAR(world.hand(0).insertion, 0.055, 1e-3) << "not moved by the operator";
  ASSERT_EQ(world.scripted_operator.records().size(), 1U);
  EXPECT_EQ(world.scripted_operator.records()[0].hint, "Push");
  world.run(7.0);
  ASSERT_EQ(world.scripted_operator.records().size(), 2U);
  EXPECT_EQ(world.scripted_operator.records()[1].hint, "Pull");
  world.run(10.0);
  EXPECT_EQ(world.scripted_operator.progress(), Progress::kDone);
}

TEST(Operator, OfAGuidedProcedureCountsEachEntryOfAWrongBranch)
{
  const auto tip = [](double insertion, double /*rotation*/)
  { return Eigen::Vector3d(std::max(0.0, insertion - 0.1), 0.0, std::min(insertion, 0.1)); };
  PlainWorld world(guidedScene("    - {advance: wire, until: {tip_in: goal}}\n",
                               "insertion: {points: [[0, 0.05], [5, 0.14], [10, 0.08], [15, 0.14]]}"),
                   tip);
  world.run(4.9);
  EXPECT_EQ(world.scripted_operator.records()[0].wrong_branches, 1);
  world.run(10.0);
  EXPECT_EQ(world.scripted_operator.records()[0].wrong_branches, 2);
  EXPECT_EQ(world.scripted_operator.records()[0].retries, 0);
}

TEST(Operator, OfAGuidedProcedureContinuesFromASavedState)
{
  const auto scene =
      guidedScene("    - {advance: wire, until: {tip_in: trunk, beyond: 0.05}, hint: Push}\n    - {wait: 9}\n",
                  "insertion: {points: [[0, 0.01], [10, 0.1]]}");
  PlainWorld world(scene);
  world.run(9.0);
  Archive saved;
  world.scripted_operator.archive(saved);
  PlainWorld other(scene);
  Archive loaded(saved.bytes());
  other.scripted_operator.archive(loaded);
  ASSERT_EQ(other.scripted_operator.records().size(), 2U);
  EXPECT_EQ(other.scripted_operator.records()[0].hint, "Push");
  EXPECT_EQ(other.scripted_operator.records()[0].outcome, Progress::kDone);
}

const std::string kInjection =
    "    - {inject: catheter, volume: 3e-6, rate: 3e-6}\n    - {wait: 0.2}\n"
    "flow: adult\ncontrast: {}\n";

TEST(Operator, InjectsOnceAndWaitsForTheEndOfTheInjection)
{
  PlainWorld world(sceneWith(kInjection));
  bool is_injecting = true;
  double injected = 2e-6;  // before the step
  world.disturbance = [&](Observation& observation)
  {
    observation.is_injecting = is_injecting;
    observation.injected_volume = injected;
  };
  EXPECT_FALSE(world.scripted_operator.takeInjection());
  world.run(0.001);
  const std::optional<contrast::Injection> injection = world.scripted_operator.takeInjection();
  ASSERT_TRUE(injection);
  EXPECT_EQ(injection->volume, 3e-6);
  EXPECT_EQ(injection->concentration, 350.0);
  EXPECT_FALSE(world.scripted_operator.takeInjection()) << "once";
  injected = 4.9e-6;
  world.run(2.0);
  EXPECT_EQ(world.scripted_operator.records().size(), 1U);
  EXPECT_EQ(world.scripted_operator.records()[0].name, "inject 3.0 ml through catheter");
  injected = 5e-6;
  is_injecting = false;
  world.run(1.0);
  EXPECT_EQ(world.scripted_operator.progress(), Progress::kDone);
}

TEST(Operator, FailsWhereItsInjectionEndsEarly)
{
  PlainWorld world(sceneWith(kInjection));
  world.run(1.0);
  EXPECT_EQ(world.scripted_operator.progress(), Progress::kFailed);
  EXPECT_NE(world.scripted_operator.failure().find("0 of 3 ml were injected: no opening of catheter was in the vessel"),
            std::string::npos)
      << world.scripted_operator.failure();
}

}  // namespace
}  // namespace endovascular_sim::procedure
