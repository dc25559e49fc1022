#include "drive/command_gate.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace endovascular_sim::drive
{
namespace
{

constexpr double kStep = 1e-3;  // s

const DriveLimits kLimits = DriveLimits().completed(1.0, 5.0, 0.05);  ///< of an instrument of 1 m

/** Runs a gate for some steps without commands. */
void runSilently(CommandGate& gate, double seconds)
{
  for (int k = 0; k < std::lround(seconds / kStep); ++k)
    gate.next(kStep);
}

TEST(CommandGate, FollowsAStreamExactly)
{
  CommandGate gate({0.04, 0.0}, kLimits);
  for (int k = 0; k < 1000; ++k)
  {
    const HandMotion command{0.04 + 3e-5 * k, 2e-3 * k};
    EXPECT_EQ(gate.offer(command), CommandVerdict::kAccepted);
    EXPECT_EQ(gate.next(kStep).insertion, command.insertion);
    EXPECT_EQ(gate.next(kStep).rotation, command.rotation);
  }
  EXPECT_EQ(gate.rejected().total(), 0U);
}

TEST(CommandGate, RejectsAWrongUnitInAStreamWithoutALastingOffset)
{
  CommandGate gate({0.04, 0.0}, kLimits);
  gate.offer({0.04, 0.0});
  gate.next(kStep);
  EXPECT_EQ(gate.offer({40.0, 0.0}), CommandVerdict::kOutOfRange);
  EXPECT_EQ(gate.next(kStep).insertion, 0.04);
  EXPECT_EQ(gate.offer({0.4, 0.0}), CommandVerdict::kJump);
  EXPECT_EQ(gate.next(kStep).insertion, 0.04);
  EXPECT_EQ(gate.offer({0.0401, 0.0}), CommandVerdict::kAccepted);
  EXPECT_EQ(gate.next(kStep).insertion, 0.0401);
  EXPECT_EQ(gate.rejected().out_of_range, 1U);
  EXPECT_EQ(gate.rejected().jumps, 1U);
}

TEST(CommandGate, RejectsValuesThatAreNotFiniteOrAbsurd)
{
  CommandGate gate({0.04, 0.0}, kLimits);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(gate.offer({nan, 0.0}), CommandVerdict::kNotFinite);
  EXPECT_EQ(gate.offer({0.04, std::numeric_limits<double>::infinity()}), CommandVerdict::kNotFinite);
  EXPECT_EQ(gate.offer({1e300, 0.0}), CommandVerdict::kOutOfRange);
  EXPECT_EQ(gate.offer({-1e300, 0.0}), CommandVerdict::kOutOfRange);
  EXPECT_EQ(gate.offer({0.04, 1e300}), CommandVerdict::kOutOfRange);
  EXPECT_EQ(gate.next(kStep).insertion, 0.04);
  EXPECT_EQ(gate.accepted(), 0U);
  EXPECT_TRUE(std::isinf(gate.silence()));
}

TEST(CommandGate, ApproachesTheFirstCommandAtLimitedSpeed)
{
  CommandGate gate({0.0, 0.0}, kLimits);
  EXPECT_EQ(gate.offer({0.3, -5.0}), CommandVerdict::kAccepted);
  HandMotion last{0.0, 0.0};
  for (int k = 0; k < 3100; ++k)
  {
    const HandMotion& now = gate.next(kStep);
    EXPECT_LE(std::abs(now.insertion - last.insertion), kLimits.approach_speed * kStep * (1.0 + 1e-9));
    EXPECT_LE(std::abs(now.rotation - last.rotation), kLimits.approach_turning_speed * kStep * (1.0 + 1e-9));
    last = now;
  }
  EXPECT_EQ(last.insertion, 0.3);
  EXPECT_EQ(last.rotation, -5.0);
}

TEST(CommandGate, ApproachesTheFirstCommandAfterSilence)
{
  CommandGate gate({0.0, 0.0}, kLimits);
  gate.offer({0.01, 0.0});
  runSilently(gate, 0.5);
  EXPECT_EQ(gate.offer({0.2, 0.0}), CommandVerdict::kAccepted);
  EXPECT_NEAR(gate.next(kStep).insertion, 0.01 + kLimits.approach_speed * kStep, 1e-12);
}

TEST(CommandGate, CorrectsAWrongFirstCommandByTheNextOne)
{
  CommandGate gate({0.04, 0.0}, kLimits);
  EXPECT_EQ(gate.offer({0.9, 0.0}), CommandVerdict::kAccepted);
  gate.next(kStep);
  EXPECT_EQ(gate.offer({0.04, 0.0}), CommandVerdict::kAccepted);
  runSilently(gate, 0.01);
  EXPECT_EQ(gate.next(kStep).insertion, 0.04);
}

TEST(CommandGate, NeverMovesFasterThanAJumpPerStepAllows)
{
  CommandGate gate({0.0, 0.0}, kLimits);
  gate.offer({0.0, 0.0});
  for (int k = 1; k <= 20; ++k)  // commands that arrive while no step is computed
    gate.offer({0.015 * k, 0.0});
  EXPECT_LE(gate.next(kStep).insertion, kLimits.approach_speed * kStep);
}

/** Gate of a stream at 40 mm/s with a command every 5 ms, of which the last 50 ms arrive together. */
CommandGate delayedGate()
{
  CommandGate gate({0.04, 0.0}, kLimits);
  gate.offer({0.04, 0.0});
  gate.next(kStep);
  for (int k = 1; k <= 10; ++k)
    EXPECT_EQ(gate.offer({0.04 + 2e-4 * k, -1e-3 * k}), CommandVerdict::kAccepted);
  return gate;
}

TEST(CommandGate, ExecutesCommandsThatArriveTogetherOverTheNextSteps)
{
  CommandGate gate = delayedGate();
  HandMotion last = gate.position();
  for (int k = 0; k < 8; ++k)
  {
    const HandMotion now = gate.next(kStep);
    EXPECT_GT(now.insertion - last.insertion, 0.0);
    EXPECT_LE(now.insertion - last.insertion, 1.25 * 2e-4 * (1.0 + 1e-9));
    EXPECT_LE(last.rotation - now.rotation, 1.25 * 1e-3 * (1.0 + 1e-9));
    last = now;
  }
  EXPECT_EQ(last.insertion, gate.target().insertion);
  EXPECT_EQ(last.rotation, gate.target().rotation);
}

TEST(CommandGate, FollowsAStreamExactlyAgainSoonAfterADelay)
{
  CommandGate gate = delayedGate();
  double target = 0.0;
  for (int k = 0; k < 40; ++k)
  {
    target = gate.target().insertion + 2e-4;
    gate.offer({target, 0.0});
    gate.next(kStep);
  }
  EXPECT_EQ(gate.position().insertion, target);
}

TEST(CommandGate, ReturnsFromBeyondAStopAtOnce)
{
  CommandGate gate = delayedGate();
  runSilently(gate, 0.02);
  gate.stopAt({0.0, 0.035});
  EXPECT_EQ(gate.next(kStep).insertion, 0.035);
  EXPECT_EQ(gate.target().insertion, 0.035);
}

TEST(CommandGate, ApproachesAJumpWhereTheLimitsClamp)
{
  DriveLimits limits = kLimits;
  limits.beyond = BeyondLimit::kClamp;
  CommandGate gate({0.04, 0.0}, limits);
  gate.offer({0.04, 0.0});
  gate.next(kStep);
  EXPECT_EQ(gate.offer({0.4, 0.0}), CommandVerdict::kAccepted);
  EXPECT_NEAR(gate.next(kStep).insertion, 0.04 + limits.approach_speed * kStep, 1e-12);
  EXPECT_EQ(gate.offer({7.0, 0.0}), CommandVerdict::kAccepted);
  EXPECT_EQ(gate.target().insertion, 1.0);
  EXPECT_EQ(gate.rejected().clamped, 2U);
  EXPECT_EQ(gate.rejected().total(), 0U);
}

TEST(CommandGate, MeasuresJumpsFromThePositionOfAnotherModeUntilTheStreamIsOld)
{
  CommandGate gate({0.04, 0.0}, kLimits);
  gate.offer({0.04, 0.0});
  gate.follow({0.3, 0.0}, kStep);
  EXPECT_EQ(gate.offer({0.04, 0.0}), CommandVerdict::kJump);
  EXPECT_EQ(gate.offer({0.301, 0.0}), CommandVerdict::kAccepted);
  EXPECT_EQ(gate.next(kStep).insertion, 0.301);
  gate.follow({0.3, 0.0}, 1.0);
  EXPECT_EQ(gate.offer({0.04, 0.0}), CommandVerdict::kAccepted) << "the first of a new stream";
  EXPECT_NEAR(gate.next(kStep).insertion, 0.3 - kLimits.approach_speed * kStep, 1e-12);
}

}  // namespace
}  // namespace endovascular_sim::drive
