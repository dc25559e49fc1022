#include "drive/hand_control.h"

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace endovascular_sim::drive
{
namespace
{

constexpr double kStep = 1e-3;  // s
const HandMotion kStart = {0.05, 0.2};
const DriveLimits kLimits = DriveLimits().completed(0.6, 1.0, 0.01);
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

JointCommand commandOf(CommandKind kind, double insertion, std::optional<double> rotation = std::nullopt,
                       std::optional<double> pressure = std::nullopt)
{
  return {kind, insertion, rotation, pressure};
}

/** Instrument that follows its setpoint, up to a stop, with springs to the start. */
class Bench
{
public:
  explicit Bench(const DriveLimits& limits = kLimits) : control(kStart, limits) {}

  CommandVerdict send(CommandKind kind, double insertion, std::optional<double> rotation = std::nullopt,
                      const std::string& client = "/a")
  {
    return control.command(client, commandOf(kind, insertion, rotation));
  }

  void run(
      double seconds, const std::function<void()>& each = [] {})
  {
    for (int k = 0; k < std::lround(seconds / kStep); ++k)
    {
      each();
      HandFeedback feedback;
      feedback.insertion = {reached.insertion, stiffness * (reached.insertion - kStart.insertion), slipped.insertion,
                            stops};
      feedback.rotation.reached = reached.rotation;
      feedback.rotation.effort = turning_stiffness * (reached.rotation - kStart.rotation);
      feedback.rotation.slipped = slipped.rotation;
      last = setpoint();
      reached = control.next(kStep, feedback).motion;
      reached.insertion = std::min(reached.insertion, stop);
    }
  }

  HandMotion setpoint() const { return control.setpoint().motion; }
  double speed() const { return (setpoint().insertion - last.insertion) / kStep; }

  HandControl control;
  HandMotion reached = kStart;
  HandMotion last = kStart;
  double stop = kInfinity;  ///< largest insertion, unknown to the control [m]
  Interval stops{-kInfinity, kInfinity};
  HandMotion slipped{};
  double stiffness = 0.0;          ///< [N/m]
  double turning_stiffness = 0.0;  ///< [N·m/rad]
};

TEST(HandControl, HoldsTheStartWithoutACommand)
{
  Bench bench;
  bench.run(1.0);
  EXPECT_EQ(bench.setpoint().insertion, kStart.insertion);
  EXPECT_EQ(bench.setpoint().rotation, kStart.rotation);
  EXPECT_EQ(bench.control.state().state, OperatingState::kEnabled);
  EXPECT_TRUE(bench.control.state().is_homed);
  EXPECT_FALSE(bench.control.state().is_busy);
}

TEST(HandControl, FollowsAStreamOfPositionsExactlyAndIsNotBusy)
{
  Bench bench;
  for (int k = 0; k < 100; ++k)
  {
    ASSERT_EQ(bench.send(CommandKind::kServoPosition, 0.05 + 5e-5 * k, 0.2), CommandVerdict::kAccepted);
    bench.run(kStep);
    EXPECT_EQ(bench.setpoint().insertion, 0.05 + 5e-5 * k);
    EXPECT_FALSE(bench.control.state().is_busy);
  }
  bench.send(CommandKind::kServoPosition, 0.055);
  bench.run(kStep);
  EXPECT_EQ(bench.setpoint().rotation, 0.2) << "the missing joint holds";
}

TEST(HandControl, AddsRelativePositionsToTheLastCommand)
{
  Bench bench;
  for (int k = 0; k < 10; ++k)
  {
    ASSERT_EQ(bench.send(CommandKind::kServoRelative, 1e-4, 1e-2), CommandVerdict::kAccepted);
    bench.run(5.0 * kStep);
  }
  EXPECT_NEAR(bench.setpoint().insertion, 0.051, 1e-12);
  EXPECT_NEAR(bench.setpoint().rotation, 0.3, 1e-12);
  EXPECT_EQ(bench.send(CommandKind::kServoRelative, 0.03), CommandVerdict::kJump) << "the rule of positions holds";
}

TEST(HandControl, RampsAnOldVelocityToZero)
{
  Bench bench;
  bench.run(0.5, [&] { bench.send(CommandKind::kServoVelocity, 0.03, 1.0); });
  EXPECT_NEAR(bench.speed(), 0.03, 1e-9);
  EXPECT_NEAR(bench.setpoint().rotation, 0.2 + 0.5, 2e-3);
  bench.run(kLimits.time_out + 0.05);
  EXPECT_EQ(bench.speed(), 0.0);
  const double rest = bench.setpoint().insertion;
  bench.run(1.0);
  EXPECT_EQ(bench.setpoint().insertion, rest);
}

TEST(HandControl, ReachesAForceAndATorque)
{
  Bench bench;
  bench.stiffness = 100.0;
  bench.turning_stiffness = 2e-3;
  bench.run(5.0, [&] { bench.send(CommandKind::kServoForce, 0.3, 1e-3); });
  EXPECT_NEAR(bench.stiffness * (bench.setpoint().insertion - kStart.insertion), 0.3, 1e-3);
  EXPECT_NEAR(bench.turning_stiffness * (bench.setpoint().rotation - kStart.rotation), 1e-3, 1e-6);
  EXPECT_EQ(bench.send(CommandKind::kServoForce, 1.1), CommandVerdict::kOutOfRange) << "beyond the grip";
}

TEST(HandControl, IsBusyDuringAMoveOnly)
{
  Bench bench;
  const std::uint64_t before = bench.control.state().revision;
  ASSERT_EQ(bench.send(CommandKind::kMovePosition, 0.25, -1.0), CommandVerdict::kAccepted);
  EXPECT_TRUE(bench.control.state().is_busy);
  EXPECT_GT(bench.control.state().revision, before);
  EXPECT_EQ(bench.control.goal().insertion, 0.25);
  bench.run(1.0);
  EXPECT_TRUE(bench.control.state().is_busy);
  EXPECT_NEAR(bench.speed(), kLimits.approach_speed, 1e-9);
  bench.run(1.2);
  EXPECT_FALSE(bench.control.state().is_busy);
  EXPECT_EQ(bench.setpoint().insertion, 0.25);
  EXPECT_EQ(bench.setpoint().rotation, -1.0);
}

TEST(HandControl, MovesRelativeToTheSetpoint)
{
  Bench bench;
  ASSERT_EQ(bench.send(CommandKind::kMoveRelative, 0.02, 0.5), CommandVerdict::kAccepted);
  bench.run(2.0);
  EXPECT_NEAR(bench.setpoint().insertion, 0.07, 1e-12);
  EXPECT_NEAR(bench.setpoint().rotation, 0.7, 1e-12);
}

TEST(HandControl, AnswersARefusedMoveWithAState)
{
  Bench bench;
  const std::uint64_t before = bench.control.state().revision;
  EXPECT_EQ(bench.send(CommandKind::kMovePosition, 5.0), CommandVerdict::kOutOfRange);
  EXPECT_GT(bench.control.state().revision, before);
  EXPECT_FALSE(bench.control.state().is_busy);
}

TEST(HandControl, ReplacesAMoveByAStreamFromWhereItIs)
{
  Bench bench;
  bench.send(CommandKind::kMovePosition, 0.4);
  bench.run(1.0);
  const double now = bench.setpoint().insertion;
  ASSERT_EQ(bench.send(CommandKind::kServoPosition, now + 1e-3), CommandVerdict::kAccepted);
  EXPECT_FALSE(bench.control.state().is_busy);
  bench.run(0.1);
  EXPECT_EQ(bench.setpoint().insertion, now + 1e-3);
}

TEST(HandControl, HoldsWhilePausedAndContinuesByResumeOnly)
{
  Bench bench;
  bench.send(CommandKind::kServoVelocity, 0.05);
  bench.run(0.1);
  EXPECT_TRUE(bench.control.stateCommand("/panel", "pause")) << "every client may pause";
  EXPECT_EQ(bench.control.state().state, OperatingState::kPaused);
  EXPECT_FALSE(bench.control.state().reason.empty());
  bench.run(0.1);
  const double held = bench.setpoint().insertion;
  bench.run(1.0, [&] { EXPECT_EQ(bench.send(CommandKind::kServoVelocity, 0.05), CommandVerdict::kNotEnabled); });
  EXPECT_EQ(bench.setpoint().insertion, held);
  bench.control.stateCommand("/a", "enable");
  EXPECT_EQ(bench.control.state().state, OperatingState::kPaused);
  EXPECT_FALSE(bench.control.stateCommand("/panel", "resume")) << "/a drives";
  EXPECT_TRUE(bench.control.stateCommand("/a", "resume"));
  EXPECT_EQ(bench.control.state().state, OperatingState::kEnabled);
  EXPECT_EQ(bench.control.state().reason, "");
  EXPECT_EQ(bench.send(CommandKind::kServoVelocity, 0.05), CommandVerdict::kAccepted);
}

TEST(HandControl, RefusesMotionWhileDisabled)
{
  Bench bench;
  bench.control.stateCommand("/a", "disable");
  EXPECT_EQ(bench.control.state().state, OperatingState::kDisabled);
  EXPECT_EQ(bench.send(CommandKind::kServoPosition, 0.051), CommandVerdict::kNotEnabled);
  bench.control.stateCommand("/a", "enable");
  EXPECT_EQ(bench.send(CommandKind::kServoPosition, 0.051), CommandVerdict::kAccepted);
}

TEST(HandControl, HomeOfADisabledInstrumentIsARefusal)
{
  Bench bench;
  bench.control.stateCommand("/a", "unhome");
  bench.control.stateCommand("/a", "disable");
  EXPECT_FALSE(bench.control.stateCommand("/a", "home"));
  EXPECT_EQ(bench.control.arbiter().lastRefusal(), "home of /a: the instrument is DISABLED");
}

TEST(HandControl, AnswersEveryStateCommandWithAState)
{
  Bench bench;
  for (const char* word : {"enable", "enable", "pause", "resume", "unhome", "home", "nonsense", "disable"})
  {
    const std::uint64_t before = bench.control.state().revision;
    bench.control.stateCommand("/a", word);
    EXPECT_GT(bench.control.state().revision, before) << word;
  }
  EXPECT_EQ(bench.control.rejected().malformed, 1U);
}

TEST(HandControl, HoldEndsAnyMotionAndNeedsNoFurtherCommand)
{
  Bench bench;
  bench.send(CommandKind::kMovePosition, 0.15, 0.0);
  bench.run(0.5);
  ASSERT_GT(bench.speed(), 0.01);
  EXPECT_TRUE(bench.control.stateCommand("/a", "hold"));
  EXPECT_FALSE(bench.control.state().is_busy);
  bench.run(0.5);
  EXPECT_EQ(bench.speed(), 0.0);
  EXPECT_LT(bench.setpoint().insertion, 0.14);
  EXPECT_EQ(bench.control.state().state, OperatingState::kEnabled);
  EXPECT_EQ(bench.send(CommandKind::kServoVelocity, 0.01), CommandVerdict::kAccepted);
}

TEST(HandControl, FreeGivesWayToTheForceUntilTheNextCommand)
{
  Bench bench;
  bench.stiffness = 100.0;
  bench.send(CommandKind::kMovePosition, 0.06, 0.2);
  bench.run(2.0);
  ASSERT_NEAR(bench.setpoint().insertion, 0.06, 1e-9);
  EXPECT_TRUE(bench.control.stateCommand("/a", "free"));
  bench.run(3.0);
  EXPECT_NEAR(bench.setpoint().insertion, kStart.insertion, 1e-3) << "also long after the time-out";
  EXPECT_TRUE(bench.control.stateCommand("/a", "hold"));
  bench.stiffness = 0.0;
  const double held = bench.setpoint().insertion;
  bench.run(1.0);
  EXPECT_NEAR(bench.setpoint().insertion, held, 1e-4);
}

TEST(HandControl, HoldAndFreeAreRefusedToOthersAndWhereNothingMoves)
{
  Bench bench;
  bench.send(CommandKind::kServoVelocity, 0.01);
  EXPECT_FALSE(bench.control.stateCommand("/b", "free"));
  EXPECT_NE(bench.control.arbiter().lastRefusal().find("/a drives"), std::string::npos);
  bench.control.stateCommand("/a", "disable");
  EXPECT_FALSE(bench.control.stateCommand("/a", "hold"));
  EXPECT_EQ(bench.control.rejected().not_enabled, 1U);
}

TEST(HandControl, HomesByAMoveToTheStart)
{
  Bench bench;
  bench.send(CommandKind::kMovePosition, 0.15, 0.0);
  bench.run(2.0);
  bench.control.stateCommand("/a", "unhome");
  EXPECT_FALSE(bench.control.state().is_homed);
  EXPECT_EQ(bench.send(CommandKind::kServoPosition, 0.15), CommandVerdict::kNotEnabled);
  EXPECT_EQ(bench.send(CommandKind::kServoVelocity, 0.01), CommandVerdict::kAccepted) << "needs no scale";
  bench.run(0.1);
  bench.control.stateCommand("/a", "home");
  EXPECT_TRUE(bench.control.state().is_busy);
  EXPECT_EQ(bench.send(CommandKind::kServoVelocity, 0.01), CommandVerdict::kNotEnabled);
  bench.run(2.0);
  EXPECT_TRUE(bench.control.state().is_homed);
  EXPECT_FALSE(bench.control.state().is_busy);
  EXPECT_EQ(bench.setpoint().insertion, kStart.insertion);
  EXPECT_EQ(bench.setpoint().rotation, kStart.rotation);
}

TEST(HandControl, BelongsToItsDriverUntilTheTimeOut)
{
  Bench bench;
  ASSERT_EQ(bench.send(CommandKind::kServoPosition, 0.05), CommandVerdict::kAccepted);
  EXPECT_EQ(bench.send(CommandKind::kServoPosition, 0.05, 0.2, "/b"), CommandVerdict::kForeign);
  EXPECT_NE(bench.control.arbiter().lastRefusal().find("/a drives"), std::string::npos);
  EXPECT_EQ(bench.control.rejected().foreign, 1U);
  bench.run(kLimits.time_out + kStep);
  EXPECT_EQ(bench.send(CommandKind::kServoPosition, 0.05, 0.2, "/b"), CommandVerdict::kAccepted);
  EXPECT_EQ(bench.control.arbiter().driver(), "/b");
  bench.control.stateCommand("/b", "disable");
  bench.control.stateCommand("/a", "enable");
  EXPECT_EQ(bench.send(CommandKind::kServoPosition, 0.05), CommandVerdict::kAccepted) << "disable releases";
}

TEST(HandControl, BelongsToTheSenderOfAMoveUntilItsEnd)
{
  Bench bench;
  bench.send(CommandKind::kMovePosition, 0.25);
  bench.run(1.0);
  EXPECT_EQ(bench.send(CommandKind::kServoPosition, 0.25, 0.2, "/b"), CommandVerdict::kForeign);
  bench.run(1.5);
  EXPECT_EQ(bench.send(CommandKind::kServoPosition, 0.25, 0.2, "/b"), CommandVerdict::kAccepted);
}

TEST(HandControl, ClampsWhereTheSceneSaysSo)
{
  DriveLimits limits = kLimits;
  limits.beyond = BeyondLimit::kClamp;
  Bench bench(limits);
  EXPECT_EQ(bench.send(CommandKind::kServoVelocity, 7.0, -100.0), CommandVerdict::kAccepted);
  EXPECT_EQ(bench.send(CommandKind::kServoForce, -7.0), CommandVerdict::kAccepted);
  EXPECT_EQ(bench.send(CommandKind::kMovePosition, 7.0), CommandVerdict::kAccepted);
  EXPECT_EQ(bench.control.goal().insertion, 0.6);
  EXPECT_EQ(bench.control.rejected().clamped, 3U);
  EXPECT_EQ(bench.control.rejected().total(), 0U);
}

TEST(HandControl, ChangesThePressureByPositionsOnly)
{
  Bench bench;
  EXPECT_FALSE(bench.control.setpoint().pressure);
  bench.control.command("/a", commandOf(CommandKind::kServoPosition, 0.05, 0.2, 2e5));
  EXPECT_EQ(bench.control.setpoint().pressure, 2e5);
  bench.send(CommandKind::kServoPosition, 0.05, 0.2);
  EXPECT_EQ(bench.control.setpoint().pressure, 2e5);
  bench.control.command("/a", commandOf(CommandKind::kServoRelative, 0.0, 0.0, 1e5));
  EXPECT_EQ(bench.control.setpoint().pressure, 3e5);
  EXPECT_EQ(bench.control.command("/a", commandOf(CommandKind::kServoPosition, 0.05, 0.2, kNan)),
            CommandVerdict::kMalformed);
  EXPECT_EQ(bench.control.setpoint().pressure, 3e5);
}

TEST(HandControl, KeepsTheSetpointBetweenTheStopsOfTheInstrument)
{
  for (const JointCommand& push :
       {commandOf(CommandKind::kServoVelocity, 0.5), commandOf(CommandKind::kServoForce, 0.9),
        commandOf(CommandKind::kServoRelative, 5e-4), commandOf(CommandKind::kMovePosition, 0.5)})
  {
    SCOPED_TRACE(nameOf(push.kind));
    Bench bench;
    bench.stops = {0.0, 0.1};
    bench.run(4.0, [&] { bench.control.command("/a", push); });
    EXPECT_TRUE(bench.control.isStopped());
    bench.run(1.0);
    EXPECT_EQ(bench.setpoint().insertion, 0.1);
  }
}

TEST(HandControl, JudgesPositionsByThatOfTheInstrumentAfterASlip)
{
  Bench bench;
  bench.slipped = {0.5, 1e4};
  bench.run(kStep);
  EXPECT_EQ(bench.send(CommandKind::kMovePosition, 1.0, 1e4), CommandVerdict::kAccepted);
  EXPECT_EQ(bench.send(CommandKind::kMovePosition, 1.2, 1e4), CommandVerdict::kOutOfRange);
  EXPECT_EQ(bench.send(CommandKind::kServoPosition, -0.2, 1e4), CommandVerdict::kOutOfRange);
  EXPECT_EQ(bench.send(CommandKind::kServoPosition, 1.05, 1e4), CommandVerdict::kAccepted);
}

TEST(HandControl, AcceptsTheEndOfTheRangeDespiteTheRoundingOfASlip)
{
  Bench bench;
  bench.slipped = {-1e-12, 1e-12};
  bench.run(kStep);
  EXPECT_EQ(bench.send(CommandKind::kMovePosition, 0.6), CommandVerdict::kAccepted);
  EXPECT_EQ(bench.send(CommandKind::kMovePosition, 0.601), CommandVerdict::kOutOfRange);
}

TEST(HandControl, LeavesAStopByTheNextVelocity)
{
  Bench bench;
  bench.stop = 0.1;
  bench.run(3.0, [&] { bench.send(CommandKind::kServoVelocity, 0.05); });
  EXPECT_EQ(bench.reached.insertion, 0.1);
  bench.run(0.2, [&] { bench.send(CommandKind::kServoVelocity, -0.05); });
  EXPECT_LT(bench.reached.insertion, 0.097);
}

/** After any messages, the instrument moves towards the next sane command within 1 s, and stays in its limits. */
TEST(HandControl, SurvivesAnyCommand)
{
  std::mt19937 random(3);
  const std::vector<double> values = {kNan, kInfinity, -kInfinity, 1e300, -1e300, 0.0, 0.05, -0.3, 0.6, 1e-3, 50.0};
  const std::vector<std::string> words = {"enable", "disable", "pause", "resume", "home", "unhome", ""};
  Bench bench;
  bench.stop = 0.5;
  const auto any = [&random](const auto& list) { return list[random() % list.size()]; };
  for (int trial = 0; trial < 200; ++trial)
  {
    for (int k = 0; k < 30; ++k)
    {
      const auto kind = static_cast<CommandKind>(random() % 6);
      bench.control.command(random() % 5 == 0 ? "/b" : "/a", commandOf(kind, any(values), any(values), any(values)));
      if (random() % 10 == 0)
        bench.control.stateCommand("/a", any(words));
      const HandMotion before = bench.setpoint();
      bench.run(kStep);
      ASSERT_TRUE(std::isfinite(bench.setpoint().insertion) && std::isfinite(bench.setpoint().rotation));
      ASSERT_TRUE(kLimits.insertion->contains(bench.setpoint().insertion));
      ASSERT_TRUE(kLimits.rotation.contains(bench.setpoint().rotation));
      ASSERT_LE(std::abs(bench.setpoint().insertion - before.insertion), kLimits.step * (1.0 + 1e-9));
    }
    bench.run(kLimits.time_out + kStep);
    for (const char* word : {"disable", "enable", "unhome"})
      ASSERT_TRUE(bench.control.stateCommand("/sane", word)) << bench.control.arbiter().lastRefusal();
    const double goal = bench.reached.insertion > 0.1 ? -0.05 : 0.05;
    const double begin = bench.reached.insertion;
    bench.run(1.0, [&] { bench.send(CommandKind::kServoVelocity, goal, 0.0, "/sane"); });
    ASSERT_GT((bench.reached.insertion - begin) / goal, 0.5) << trial;
    bench.run(kLimits.time_out + kStep);
    ASSERT_TRUE(bench.control.stateCommand("/a", "home"));
    bench.run(8.0);
  }
}

TEST(HandControl, IsAFunctionOfCommandsAndSteps)
{
  const auto run = []
  {
    Bench bench;
    bench.stiffness = 30.0;
    double sum = 0.0;
    for (const CommandKind kind : {CommandKind::kServoVelocity, CommandKind::kServoForce, CommandKind::kMoveRelative})
      bench.run(0.7,
                [&]
                {
                  bench.send(kind, 0.01, 0.001);
                  sum = std::fma(sum, 0.999, bench.setpoint().insertion);
                });
    return sum;
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace endovascular_sim::drive
