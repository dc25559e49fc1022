#include "flow/body/heart.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/archive.h"

namespace endovascular_sim::flow
{
namespace
{

constexpr double kStep = 1e-3;  // [s]

TEST(Heart, EjectsTheCardiacOutputAtItsRate)
{
  for (const double rate : {1.0, 70.0 / 60.0, 2.5})
  {
    HeartSettings settings;
    Heart heart(settings);
    heart.setRate(rate);
    double volume = 0.0;
    const int steps = static_cast<int>(std::lround(60.0 / kStep));
    for (int k = 0; k < steps; ++k)
    {
      heart.advance(kStep);
      volume += heart.inflow() * kStep;
    }
    EXPECT_NEAR(heart.beats(), 60.0 * rate, 1.0);
    EXPECT_NEAR(volume, 60.0 * settings.output, 0.02 * 60.0 * settings.output) << rate;
  }
}

TEST(Heart, HasALargestStrokeVolume)
{
  HeartSettings settings;
  Heart heart(settings);
  heart.setRate(0.5);
  for (int k = 0; k < 3000; ++k)
    heart.advance(kStep);
  EXPECT_EQ(heart.strokeVolume(), settings.largest_stroke);
}

TEST(Heart, EjectsLessAgainstAHighPressureAndNothingAgainstTheLargest)
{
  HeartSettings settings;
  Heart heart(settings);
  for (int k = 0; k < 100; ++k)
    heart.advance(kStep);
  ASSERT_GT(heart.inflow(), 0.0);
  EXPECT_EQ(heart.inflow(1.6e4), heart.inflow());
  EXPECT_NEAR(heart.inflow(5.0 / 6.0 * settings.largest_pressure), 0.5 * heart.inflow(), 1e-9 * heart.inflow());
  EXPECT_EQ(heart.inflow(1.1 * settings.largest_pressure), 0.0);
  while (heart.inflow() >= 0.0)
    heart.advance(kStep);
  EXPECT_EQ(heart.inflow(1e5), heart.inflow()) << "the closing valve lets the same volume pass";
}

TEST(Heart, HasAShorterEjectionAtAHigherRate)
{
  EXPECT_NEAR(Heart::ejectionTime(70.0 / 60.0), 0.294, 1e-3);  // Weissler, Harris & Schoenfeld 1968
  double before = 1.0;
  for (double rate = 0.5; rate < 4.0; rate += 0.1)
  {
    const double time = Heart::ejectionTime(rate);
    EXPECT_LE(time, before);
    EXPECT_LT(time, 0.61 / rate);
    before = time;
  }
}

TEST(Heart, ContractsBeforeItEjectsAndRelaxesAfterwards)
{
  HeartSettings settings;
  Heart heart(settings);
  double before = heart.activation();
  for (int k = 0; k < 5000; ++k)
  {
    heart.advance(kStep);
    EXPECT_GE(heart.activation(), 0.0);
    EXPECT_LE(heart.activation(), 1.0);
    EXPECT_LT(std::abs(heart.activation() - before), k < 2 ? 1.01 : 0.05) << "at " << k * kStep << " s";
    before = heart.activation();
    if (heart.inflow() > 0.0)
    {
      EXPECT_EQ(heart.activation(), 1.0);
    }
  }
  EXPECT_EQ(heart.ventricle(12e3), settings.filling_pressure + heart.activation() * (12e3 - settings.filling_pressure));
}

TEST(Heart, StopsAfterTheBeatAndBeginsAgain)
{
  HeartSettings settings;
  Heart heart(settings);
  for (int k = 0; k < 1000; ++k)
    heart.advance(kStep);
  heart.setRate(0.0);
  for (int k = 0; k < 5000; ++k)
    heart.advance(kStep);
  EXPECT_EQ(heart.beats(), 2U);
  EXPECT_EQ(heart.inflow(), 0.0);
  EXPECT_EQ(heart.activation(), 0.0);
  heart.setRate(1.0);
  for (int k = 0; k < 3100; ++k)
    heart.advance(kStep);
  EXPECT_EQ(heart.beats(), 5U);
}

TEST(Heart, ContinuesFromAnArchive)
{
  Heart first{HeartSettings()}, second{HeartSettings()};
  first.setRate(1.3);
  for (int k = 0; k < 1234; ++k)
    first.advance(kStep);
  Archive written;
  first.archive(written);
  Archive read(written.bytes());
  second.archive(read);
  for (int k = 0; k < 2000; ++k)
  {
    first.advance(kStep);
    second.advance(kStep);
    ASSERT_EQ(first.inflow(), second.inflow());
  }
}

}  // namespace
}  // namespace endovascular_sim::flow
