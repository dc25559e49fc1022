#include "haptics/force/force_filter.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/units.h"

namespace endovascular_sim::haptics
{
namespace
{

using units::kPi;

TEST(ForceFilter, IsOffByDefaultAndPassesForcesBitForBit)
{
  ForceFilter filter;
  for (int k = 0; k < 10; ++k)
  {
    const HandForce out = filter.next({0.1 * k, -1e-3 * k}, 1e-3 * k);
    EXPECT_EQ(out.force, 0.1 * k);
    EXPECT_EQ(out.torque, -1e-3 * k);
  }
}

/** Amplitude of a filtered sine wave of amplitude 1. */
double gain(double cutoff, double frequency)
{
  ForceFilter filter(cutoff);
  const double dt = 1e-4;
  double largest = 0.0;
  for (int k = 0; k < 10000; ++k)
  {
    const double out = filter.next({std::sin(2.0 * kPi * frequency * k * dt), 0.0}, k * dt).force;
    if (k > 5000)
      largest = std::max(largest, std::abs(out));
  }
  return largest;
}

TEST(ForceFilter, IsASecondOrderButterworthLowPass)
{
  EXPECT_NEAR(gain(50.0, 5.0), 1.0, 0.01);
  EXPECT_NEAR(gain(50.0, 50.0), std::sqrt(0.5), 0.03);
  EXPECT_NEAR(gain(50.0, 500.0), 0.01, 3e-3);
}

TEST(ForceFilter, DelaysARampByTheDocumentedTime)
{
  ForceFilter filter(100.0);
  HandForce out;
  for (int k = 0; k <= 300; ++k)
    out = filter.next({1e-3 * k, -1e-3 * k}, 1e-3 * k);
  const double delay = std::sqrt(2.0) / (2.0 * kPi * 100.0);
  EXPECT_NEAR(0.3 - out.force, delay, 0.05 * delay);
  EXPECT_NEAR(0.3 + out.torque, delay, 0.05 * delay);
}

TEST(ForceFilter, IsStableAtAnyRateAndStartsAtTheFirstForce)
{
  ForceFilter filter(100.0);
  EXPECT_EQ(filter.next({2.0, 0.0}, 0.0).force, 2.0);
  double largest = 0.0;
  for (int k = 1; k < 50; ++k)
    largest = std::max(largest, std::abs(filter.next({k % 2 == 0 ? 1.0 : -1.0, 0.0}, 0.5 * k).force));
  EXPECT_LE(largest, 1.1);
  filter.reset();
  EXPECT_EQ(filter.next({-3.0, 0.0}, 100.0).force, -3.0);
}

TEST(ForceFilter, PassesNonFiniteForcesWithoutStoringThem)
{
  ForceFilter filter(100.0);
  filter.next({1.0, 0.0}, 0.0);
  EXPECT_TRUE(std::isnan(filter.next({std::nan(""), 0.0}, 1e-3).force)) << "the output stage releases the force";
  EXPECT_TRUE(std::isfinite(filter.next({1.0, 0.0}, 2e-3).force));
}

}  // namespace
}  // namespace endovascular_sim::haptics
