#include "benchmark/sheet/channel_statics.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kRadius = 0.05;  // of the bend [m]

ChannelProblem bend(double inserted, double tail = 0.0)
{
  ChannelProblem problem;
  problem.pieces = {{0.04, 0.0, 0.0}, {0.5 * M_PI * kRadius, 1.0 / kRadius, 0.0}, {0.04, 0.0, 0.0}};
  problem.clearance = problem.tail_clearance = 1.5e-4;
  problem.bending_stiffness = 3e-4;
  problem.tail_stiffness = 1.5e-4;
  problem.inserted_length = inserted;
  problem.tail_length = tail;
  problem.advance = 0.0;
  return problem;
}

TEST(ChannelStatics, WithoutFrictionNeedNoForceOnceTheTipHasLeftTheBend)
{
  const double unit = 3e-4 / (kRadius * kRadius);
  EXPECT_NEAR(channelStatics(bend(0.15)).hand_force, 0.0, 0.02 * unit);
}

TEST(ChannelStatics, WithoutFrictionPushWithTheBendingEnergyPerLength)
{
  const double unit = 3e-4 / (kRadius * kRadius);
  // ½EI/R² while the bend fills; the wire's curvature differs from that of the axis by a few percent.
  EXPECT_NEAR(channelStatics(bend(0.10)).hand_force, 0.5 * unit, 0.08 * 0.5 * unit);
}

TEST(ChannelStatics, ForceOfATailedWireIsThatOfItsOwnStiffness)
{
  // The tail is in the bend already: only the difference of both stiffnesses has to be bent.
  ChannelProblem problem = bend(0.09, 0.06);
  EXPECT_NEAR(trackingForce(problem), 0.5 * 1.5e-4 / (kRadius * kRadius), 0.1 * 0.5 * 1.5e-4 / (kRadius * kRadius));
}

// The work of the hand as the wire slides along itself: its bending energy stays the same.
TEST(ChannelStatics, ForceOfTheHandIsThatOfTheTipAndOfTheFriction)
{
  ChannelProblem problem = bend(0.15);
  problem.friction = 0.1;
  problem.advance = 1.0;
  problem.tip_force = 5.0 * 3e-4 / (kRadius * kRadius);
  const ChannelState state = channelStatics(problem);
  const double expected = problem.tip_force + 0.1 * state.totalNormalForce();
  EXPECT_NEAR(state.hand_force, expected, 0.005 * expected);
  EXPECT_GT(state.totalNormalForce(), problem.tip_force * 0.5 * M_PI);
}

TEST(ChannelStatics, TurnedWireCarriesTheTorqueOfItsContacts)
{
  const ChannelState state = channelStatics(bend(0.15));
  const ChannelTorque found = channelTorque(state, 0.1, 4e-4, 2e-4);
  EXPECT_NEAR(found.torque, 0.1 / std::sqrt(1.01) * 4e-4 * state.totalNormalForce(), 1e-12);
  EXPECT_GT(found.lag, 0.0);
  EXPECT_LT(found.lag, found.torque * 0.15 / 2e-4);
  EXPECT_GT(state.totalNormalForce(), 3e-4 / (kRadius * kRadius));
}

}  // namespace
}  // namespace endovascular_sim::benchmark
