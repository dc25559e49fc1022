#include "drive/axis_control.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::drive
{
namespace
{

constexpr double kStep = 1e-3;  // s
const AxisLimits kLimits = {{-0.5, 0.5}, 0.2, 2.0, 0.1, 0.02};

/** Axis whose instrument follows at once. */
struct FreeAxis
{
  AxisControl axis{kLimits, 0.1};

  double next(double effort = 0.0) { return axis.next(kStep, {axis.position(), effort}); }
};

TEST(AxisControl, ReachesAVelocityWithTheLargestAcceleration)
{
  FreeAxis free;
  free.axis.setVelocity(0.05);
  double last = 0.1;
  for (int k = 1; k <= 200; ++k)
  {
    const double now = free.next();
    EXPECT_NEAR((now - last) / kStep, std::min(0.05, k * kLimits.acceleration * kStep), 1e-9);
    last = now;
  }
  free.axis.hold();
  for (int k = 0; k < 25; ++k)
    free.next();
  EXPECT_EQ(free.axis.velocity(), 0.0);
}

TEST(AxisControl, StopsAtTheEndOfItsRangeAndReturns)
{
  FreeAxis free;
  free.axis.setVelocity(0.2);
  double largest_change = 0.0;
  double velocity = 0.0;
  for (int k = 0; k < 4000; ++k)
  {
    EXPECT_LE(free.next(), 0.5);
    if (free.axis.position() < 0.4995)  // the last half millimetre is left to the discretisation of the root
      largest_change = std::max(largest_change, std::abs(free.axis.velocity() - velocity));
    velocity = free.axis.velocity();
  }
  EXPECT_NEAR(free.axis.position(), 0.5, 1e-4);
  EXPECT_LE(largest_change, 1.1 * kLimits.acceleration * kStep);
  free.axis.setVelocity(-0.2);
  for (int k = 0; k < 1000; ++k)
    free.next();
  EXPECT_LT(free.axis.position(), 0.35);
}

TEST(AxisControl, ReachesAnEffortAgainstASpringWithTheTimeConstantOfItsGain)
{
  const double stiffness = 200.0;  // N/m
  FreeAxis free;
  free.axis.setEffort(0.4);
  const double time_constant = 1.0 / (kLimits.gain * stiffness);  // 0.25 s
  for (int k = 0; k < std::lround(time_constant / kStep); ++k)
    free.next(stiffness * (free.axis.position() - 0.1));
  EXPECT_NEAR(stiffness * (free.axis.position() - 0.1), 0.4 * (1.0 - std::exp(-1.0)), 0.01);
  for (int k = 0; k < 4000; ++k)
    free.next(stiffness * (free.axis.position() - 0.1));
  EXPECT_NEAR(stiffness * (free.axis.position() - 0.1), 0.4, 1e-5);
}

TEST(AxisControl, FollowsAMoveAndIsAtRestAtItsGoal)
{
  FreeAxis free;
  free.axis.moveTo(-0.2);
  const TrapezoidalMove move(0.1, 0.0, -0.2, kLimits.move_speed, kLimits.acceleration);
  int steps = 0;
  for (; free.axis.isMoving(); ++steps)
  {
    free.next();
    EXPECT_NEAR(free.axis.position(), move.position((steps + 1) * kStep), 1e-12) << steps;
    ASSERT_LT(steps, 10000);
  }
  EXPECT_NEAR(steps * kStep, move.duration(), 2.1 * kStep);
  EXPECT_EQ(free.axis.position(), -0.2);
  EXPECT_EQ(free.axis.velocity(), 0.0);
}

TEST(AxisControl, OfNoDistanceMovesForAStep)
{
  FreeAxis free;
  free.axis.moveTo(0.1);
  EXPECT_TRUE(free.axis.isMoving());
  free.next();
  EXPECT_TRUE(free.axis.isMoving()) << "so that it can be observed";
  free.next();
  EXPECT_FALSE(free.axis.isMoving());
}

TEST(AxisControl, LeadsAStoppedInstrumentByLittleAndReversesAtOnce)
{
  AxisControl axis(kLimits, 0.1);
  axis.setVelocity(0.1);
  for (int k = 0; k < 2000; ++k)
    axis.next(kStep, {0.12, 0.0});  // the instrument does not move beyond 0.12
  EXPECT_LE(axis.position(), 0.12 + 0.1 * 0.05 + 1e-5);
  axis.setVelocity(-0.1);
  for (int k = 0; k < 200; ++k)
    axis.next(kStep, {std::min(0.12, axis.position()), 0.0});
  EXPECT_LT(axis.position(), 0.12);
}

}  // namespace
}  // namespace endovascular_sim::drive
