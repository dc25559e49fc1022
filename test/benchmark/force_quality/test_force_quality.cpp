#include "benchmark/force_quality/force_quality.h"

#include <cmath>

#include <gtest/gtest.h>

#include "benchmark/force_quality/force_quality_study.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kStep = 1e-3;  // s

/** 1.3 s of a push at 10 mm/s without turning. @param force over the time [N] */
std::vector<HandReaction> push(const std::function<double(double)>& force)
{
  std::vector<HandReaction> reactions;
  for (int k = 0; k <= 1300; ++k)
    reactions.push_back({1e-2 * k * kStep, 0.0, force(k * kStep), 0.0});
  return reactions;
}

}  // namespace

TEST(ForceQuality, OfALinearForceHasNoNoise)
{
  const HandQuality quality = handQuality(push([](double t) { return 1.0 + 0.5 * t; }), kStep);
  EXPECT_EQ(quality.force.windows, 4);
  EXPECT_NEAR(quality.force.deviation, 0.0, 1e-12);
  EXPECT_NEAR(quality.force.mean, 1.375, 1e-12);
  EXPECT_NEAR(quality.force.largest_change, 0.5e-3, 1e-12);
  EXPECT_EQ(quality.torque.windows, 0);
  EXPECT_TRUE(std::isnan(quality.torque.noise()));
}

TEST(ForceQuality, MeasuresTheDeviationOfASineAndAJump)
{
  const HandQuality sine =
      handQuality(push([](double t) { return 2.0 + 0.1 * std::sin(2.0 * M_PI * 40.0 * t); }), kStep);
  EXPECT_NEAR(sine.force.noise(), 0.1 / std::sqrt(2.0) / 2.0, 1e-3);
  const HandQuality jump = handQuality(push([](double t) { return t < 0.6 ? 1.0 : 1.3; }), kStep);
  EXPECT_NEAR(jump.force.largest_change, 0.3, 1e-12);
  EXPECT_NEAR(jump.force.change_time, 0.6, 2e-3);
}

TEST(ForceQuality, ChangesOfTheReferenceDoNotCount)
{
  const auto force = [](double t) { return t < 0.6 ? 1.0 : 1.3; };
  const HandQuality quality = handQuality(push([&](double t) { return force(t) + (t < 0.3 ? 0.0 : 0.02); }), kStep,
                                          [&](double insertion) { return force(100.0 * insertion); });
  EXPECT_NEAR(quality.force.largest_change, 0.02, 1e-12);
}

TEST(ForceQuality, WindowsWithAPauseOrAReversalDoNotCount)
{
  std::vector<HandReaction> reactions = push([](double) { return 1.0; });
  for (int k = 300; k <= 320; ++k)
    reactions[static_cast<std::size_t>(k)].insertion = reactions[300].insertion;  // a pause
  for (int k = 600; k <= 1300; ++k)
    reactions[static_cast<std::size_t>(k)].insertion = 2.0 * reactions[600].insertion - 1e-2 * k * kStep;
  reactions[310].force = reactions[610].force = 5.0;
  const HandQuality quality = handQuality(reactions, kStep);
  EXPECT_EQ(quality.force.windows, 2);
  EXPECT_EQ(quality.force.largest_change, 0.0);
}

TEST(ForceQuality, OfShippedScenesIsMeasuredAlsoWhereClientsDrive)
{
  const auto tube = reactionsIn("tube", {}, 1.0);
  ASSERT_EQ(tube.size(), 1U);
  EXPECT_EQ(handQuality(tube[0], kStep).force.windows, 2);
  const auto fork = reactionsIn("fork", {}, 1.2);
  ASSERT_EQ(fork.size(), 1U);
  EXPECT_GE(handQuality(fork[0], kStep).force.windows, 3);
  EXPECT_GE(handQuality(fork[0], kStep).torque.windows, 2);
}

}  // namespace endovascular_sim::benchmark
