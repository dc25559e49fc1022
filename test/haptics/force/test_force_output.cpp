#include "haptics/force/force_output.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace endovascular_sim::haptics
{
namespace
{

TEST(ForceOutput, ClampsToTheLimits)
{
  ForceLimits limits;
  limits.force = 2.0;
  limits.torque = 0.01;
  ForceOutput output(limits);
  for (int i = 0; i < 300; ++i)
  {
    output.command({100.0, -1.0}, 1e-3 * i);
    output.advance(1e-3 * i);
    EXPECT_LE(output.value().force, 2.0);
  }
  EXPECT_EQ(output.value().force, 2.0);
  EXPECT_EQ(output.value().torque, -0.01);
}

TEST(ForceOutput, LimitsTheRateAfterAPauseToo)
{
  ForceLimits limits;
  limits.force_rate = 100.0;
  ForceOutput output(limits);
  output.command({0.0, 0.0}, 0.0);
  output.command({5.0, 0.0}, 1.0);
  EXPECT_LE(output.advance(1.0).force, 1.0);
  EXPECT_NEAR(output.advance(1.002).force - output.advance(1.001).force, 0.0, 1e-12) << "time does not run backwards";
}

TEST(ForceOutput, ReturnsWithinTheReturnTimeAfterARelease)
{
  ForceLimits limits;
  limits.force = 5.0;
  limits.return_time = 0.25;
  ForceOutput output(limits);
  double time = 0.0;
  const auto follow = [&output, &time](double force, int steps)
  {
    for (int k = 0; k < steps; ++k, time += 1e-3)
    {
      output.command({force, 0.0}, time);
      output.advance(time);
    }
    return output.value().force;
  };
  EXPECT_NEAR(follow(2.0, 11), 0.2, 1e-9) << "the force returns at 20 N/s from the start";
  EXPECT_EQ(follow(2.0, 200), 2.0);
  EXPECT_NEAR(follow(2.4, 2), 2.4, 1e-9) << "once it has met its target, the ordinary rate applies";
  output.release(time);
  time += 0.1;
  output.advance(time);
  EXPECT_TRUE(output.isZero());
  EXPECT_LE(follow(2.4, 5), 0.11) << "half a newton within one frame would be felt as an impact";
  EXPECT_EQ(follow(2.4, 200), 2.4);
}

TEST(ForceOutput, RampsToExactlyZeroWithinTheRampTime)
{
  ForceLimits limits;
  limits.return_time = 0.01;
  ForceOutput output(limits);
  for (int i = 0; i < 100; ++i)
    output.command({3.0, 0.02}, 1e-3 * i);
  const double start = 0.1;
  ASSERT_EQ(output.advance(start).force, 3.0);
  output.release(start);
  double previous = 3.0;
  for (double t = 0.0; t < limits.ramp_time; t += 1e-3)
  {
    output.release(start + t);  // a repeated release must not restart the ramp
    const double force = output.advance(start + t).force;
    EXPECT_LE(force, previous);
    previous = force;
  }
  EXPECT_GT(previous, 0.0);
  EXPECT_EQ(output.advance(start + limits.ramp_time).force, 0.0);
  EXPECT_TRUE(output.isZero());
  EXPECT_LE(limits.ramp_time, 50e-3);
}

TEST(ForceOutput, ReleasesOnANonFiniteForce)
{
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()})
  {
    ForceOutput output;
    for (int i = 0; i < 20; ++i)
      EXPECT_TRUE(output.command({1.0, 0.01}, 1e-3 * i));
    EXPECT_FALSE(output.command({bad, 0.0}, 0.02));
    EXPECT_FALSE(output.command({0.0, bad}, 0.03));
    EXPECT_TRUE(std::isfinite(output.advance(0.03).force));
    output.advance(0.07);
    EXPECT_TRUE(output.isZero());
  }
}

TEST(ForceOutput, CutsImmediately)
{
  ForceOutput output;
  output.command({1.0, 0.01}, 0.0);
  output.advance(0.01);
  output.cut();
  EXPECT_TRUE(output.isZero());
}

}  // namespace
}  // namespace endovascular_sim::haptics
