#include "rod/boundary/hemostatic_valve.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::rod
{
namespace
{

constexpr double kFriction = 0.3;  // N
constexpr double kRadius = 4e-4;   // m

/** Advances the valve in equal parts, as sub-steps do. */
void move(const HemostaticValve& valve, State& state, double travel, double turn, int parts)
{
  for (int k = 0; k < parts; ++k)
  {
    valve.release(state);
    valve.drag(state, travel / parts, turn / parts, kRadius);
  }
}

}  // namespace

TEST(HemostaticValve, ResistsPushingAndPullingWithItsFriction)
{
  const HemostaticValve valve(kFriction);
  State state;
  state.hand_force = 0.1;
  move(valve, state, 1e-3, 0.0, 20);
  EXPECT_NEAR(state.hand_force, 0.1 + kFriction, 1e-12);
  move(valve, state, -1e-3, 0.0, 20);
  EXPECT_NEAR(state.hand_force, 0.1 - kFriction, 1e-12);
}

TEST(HemostaticValve, SticksWithinAMicrometre)
{
  const HemostaticValve valve(kFriction);
  State state;
  move(valve, state, 0.5e-6, 0.0, 3);
  EXPECT_NEAR(state.hand_force, 0.5 * kFriction, 1e-12);
  move(valve, state, 0.0, 0.0, 1000);
  EXPECT_NEAR(state.hand_force, 0.5 * kFriction, 1e-12);
  move(valve, state, -0.5e-6, 0.0, 3);
  EXPECT_NEAR(state.hand_force, 0.0, 1e-12);
}

TEST(HemostaticValve, SharesItsFrictionBetweenPushingAndTurningByTheDirectionOfSliding)
{
  const HemostaticValve valve(kFriction);
  State state;
  const double travel = 1e-3;
  const double turn = 2.0 * travel / kRadius;
  move(valve, state, travel, turn, 50);
  const double share = 1.0 / std::sqrt(5.0);
  EXPECT_NEAR(state.hand_force, kFriction * share, 1e-9);
  EXPECT_NEAR(state.hand_torque, kRadius * kFriction * 2.0 * share, 1e-12);
  EXPECT_NEAR(std::hypot(state.hand_force, state.hand_torque / kRadius), kFriction, 1e-12);
}

TEST(HemostaticValve, DependsOnTheDisplacementAndNotOnTheSteps)
{
  const HemostaticValve valve(kFriction);
  State coarse;
  State fine;
  for (const double travel : {3e-6, -0.4e-6, 1e-3, -2.2e-6, 0.6e-6})
  {
    move(valve, coarse, travel, 0.0, 1);
    move(valve, fine, travel, 0.0, 700);
    EXPECT_NEAR(coarse.hand_force, fine.hand_force, 1e-9 * kFriction);
  }
}

TEST(HemostaticValve, WithoutFrictionChangesNothing)
{
  State state;
  state.hand_force = 0.123;
  move(HemostaticValve(0.0), state, 1e-3, 1.0, 3);
  EXPECT_EQ(state.hand_force, 0.123);
  EXPECT_EQ(state.hand_parts.valve, 0.0);
  EXPECT_TRUE(state.valve_stretch.isZero(0.0));
}

}  // namespace endovascular_sim::rod
