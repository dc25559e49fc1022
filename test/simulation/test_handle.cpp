#include "simulation/handle.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

// Part of the commands of a hand that reaches its instrument.

namespace endovascular_sim::simulation
{
namespace
{

constexpr double kStep = 1e-3;  // s
constexpr HandleRange kRange = {-std::numeric_limits<double>::infinity(), 0.0, 0.2};

scene::DriveScene driveWith(drive::Grip grip)
{
  scene::DriveScene drive;
  drive.grip = grip;
  drive.limits.speed = 0.1;
  drive.limits.turning_speed = 10.0;
  drive.force_limit = 2.0;
  drive.torque_limit = 1e-3;
  return drive;
}

Handle handleOf(drive::Grip grip)
{
  return Handle(driveWith(grip), StaleContactPacer(1e-4, kStep));
}

HandState at(double insertion, double force = 0.0)
{
  HandState state;
  state.insertion = insertion;
  state.force = force;
  return state;
}

TEST(Handle, MovesAtMostAtTheSpeedOfItsDrive)
{
  Handle handle = handleOf(drive::Grip::kFingers);
  const drive::HandIncrement motion = handle.wanted(at(0.05), {0.06, -1.0, 0.0}, &kRange, false, kStep);
  EXPECT_DOUBLE_EQ(motion.insertion, 0.1 * kStep);
  EXPECT_DOUBLE_EQ(motion.rotation, -10.0 * kStep);
}

TEST(Handle, OfFingersSlipsBeyondItsLimitAndRemembersTheSlip)
{
  Handle handle = handleOf(drive::Grip::kFingers);
  const drive::HandIncrement wanted = {1e-4, 0.0};
  EXPECT_EQ(handle.allowed(at(0.05, 4.0), wanted, kRange, kStep).insertion, 0.0);
  EXPECT_DOUBLE_EQ(handle.slipped().insertion, 1e-4);
  // Afterwards the command leads to a position that is farther back by the slip.
  EXPECT_NEAR(handle.wanted(at(0.05), {0.05 + 1e-4, 0.0, 0.0}, &kRange, false, kStep).insertion, 0.0, 1e-15);
}

TEST(Handle, OfAChuckStopsBeyondItsLimitAndDoesNotSlip)
{
  Handle handle = handleOf(drive::Grip::kChuck);
  EXPECT_EQ(handle.allowed(at(0.05, 4.0), {1e-4, 0.0}, kRange, kStep).insertion, 0.0);
  EXPECT_EQ(handle.slipped().insertion, 0.0);
  // It pushes on slowly.
  EXPECT_DOUBLE_EQ(handle.wanted(at(0.05), {0.06, 0.0, 0.0}, &kRange, false, kStep).insertion, 0.05 * 0.1 * kStep);
}

TEST(Handle, LosesItsGripGraduallyNearItsLimit)
{
  Handle handle = handleOf(drive::Grip::kFingers);
  const double first = handle.allowed(at(0.05, 1.95), {1e-4, 0.0}, kRange, kStep).insertion;
  const double second = handle.allowed(at(0.05, 1.95), {1e-4, 0.0}, kRange, kStep).insertion;
  EXPECT_LT(first, 1e-4);
  EXPECT_LT(second, first);
  EXPECT_GT(second, 0.25e-4);
}

TEST(Handle, EndsAtTheStops)
{
  Handle handle = handleOf(drive::Grip::kChuck);
  EXPECT_DOUBLE_EQ(handle.allowed(at(0.19995), {1e-4, 0.0}, kRange, kStep).insertion, 0.2 - 0.19995);
  EXPECT_DOUBLE_EQ(handle.allowed(at(0.00005), {-1e-4, 0.0}, kRange, kStep).insertion, -0.00005);
  // An instrument that does not fit waits, and is not drawn back.
  const HandleRange waiting = {-0.1, 0.05, 0.01};
  EXPECT_DOUBLE_EQ(handle.wanted(at(0.05), {0.06, 0.0, 0.0}, &waiting, false, kStep).insertion, 0.0);
}

TEST(Handle, TakesOverASlipOfTheSolution)
{
  Handle handle = handleOf(drive::Grip::kFingers);
  handle.noteSlip(0.05, 0.0501, 0.05005);
  EXPECT_DOUBLE_EQ(handle.slipped().insertion, 0.0501 - 0.05005);
  EXPECT_NEAR(handle.allowed(at(0.05), {1e-4, 0.0}, kRange, kStep).insertion, 0.55e-4, 1e-9);
}

TEST(Handle, WithoutAnIntroducerOnlyTurns)
{
  Handle handle = handleOf(drive::Grip::kFingers);
  const drive::HandIncrement motion = handle.wanted(at(0.0), {0.5, 1e-3, 0.0}, nullptr, false, kStep);
  EXPECT_EQ(motion.insertion, 0.0);
  EXPECT_DOUBLE_EQ(motion.rotation, 1e-3);
}

}  // namespace
}  // namespace endovascular_sim::simulation
