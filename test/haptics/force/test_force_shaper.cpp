#include "haptics/force/force_shaper.h"

#include <cmath>

#include <gtest/gtest.h>

#include "test/haptics/host_fixture.h"

namespace endovascular_sim::haptics
{
namespace
{

constexpr double kCount = 1e-4;  // resolution of the encoder [m]

/** Simulates a mass on a device with a coarse encoder against a stiff wall, through the complete host and its bytes.
 *  @return largest speed in the last half second [m/s] */
double lastSpeed(test::Bench& bench, double stiffness)
{
  const double mass = 0.2;
  const double hand_stiffness = 200.0;
  const double damping = 0.5;
  double x = -5e-3;
  double speed = 0.0;
  double largest = 0.0;
  const int steps = 3000;
  for (int k = 0; k < steps; ++k)
  {
    bench.insertion = static_cast<float>(kCount * std::floor(x / kCount));
    // The simulation responds to the motion of the previous step, relative to the initial position of the device.
    const double seen = bench.motions.empty() ? 0.0 : bench.motions.back().command.insertion;
    bench.simulated = {stiffness * std::max(0.0, seen - 5e-3), 0.0};
    bench.step();
    const double force = bench.forces.empty() ? 0.0 : static_cast<double>(bench.forces.back().force);
    EXPECT_LE(std::abs(force), 5.0F);
    for (int i = 0; i < 20; ++i)
    {
      speed += 5e-5 * (hand_stiffness * (2e-3 - x) - damping * speed - force) / mass;
      x += 5e-5 * speed;
    }
    if (k > steps - 500)
      largest = std::max(largest, std::abs(speed));
  }
  return largest;
}

TEST(ForceShaper, StabilisesACoarseDeviceAtAStiffWallThroughTheCompleteHost)
{
  HostOptions without = test::hostOptions();
  without.shaping.passivity = false;
  test::Bench bare(without);
  test::Bench shaped;
  const double oscillation = lastSpeed(bare, 2000.0);
  EXPECT_GT(oscillation, 0.1);
  EXPECT_EQ(bare.host.shaper().insertion().activations, 0U);
  EXPECT_LT(lastSpeed(shaped, 2000.0), 0.3 * oscillation);
  EXPECT_GT(shaped.host.shaper().insertion().activations, 0U);
  EXPECT_GT(shaped.host.shaper().insertion().dissipated, 0.0);
  EXPECT_EQ(shaped.host.shaper().rotation().activations, 0U);
}

TEST(ForceShaper, UsesArrivalTimesForADeviceWithoutAClock)
{
  ForceShaper with;
  ForceShaper without;
  for (std::uint32_t k = 0; k < 2000; ++k)
  {
    const double now = 1e-3 * k;
    const HandMotion motion{2e-3 * std::sin(60.0 * now), 0.0};
    with.sample(motion, 1000U + 1000U * k, now);
    without.sample(motion, 0, now);
    // Negative damping.
    const HandForce force{-0.6 * std::cos(60.0 * now), 0.0};
    with.rendered(force, now);
    without.rendered(force, now);
  }
  EXPECT_GT(with.insertion().activations, 0U);
  EXPECT_EQ(with.insertion().activations, without.insertion().activations);
  EXPECT_NEAR(with.insertion().energy, without.insertion().energy, 1e-3 * std::abs(with.insertion().energy));
}

TEST(ForceShaper, PassesTheForceUnchangedWhenDisabled)
{
  ShaperSettings settings;
  settings.passivity = false;
  ForceShaper shaper(settings);
  for (std::uint32_t k = 0; k < 1000; ++k)
  {
    const double now = 1e-3 * k;
    shaper.sample({2e-3 * std::sin(60.0 * now), 0.0}, 1000U * k, now);
    const HandForce force{-3.0 * std::cos(60.0 * now), 0.01};
    EXPECT_EQ(shaper.shape(force, now).force, force.force);
    shaper.rendered(force, now);
  }
}

}  // namespace
}  // namespace endovascular_sim::haptics
