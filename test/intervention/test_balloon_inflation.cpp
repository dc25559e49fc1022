#include "intervention/balloon_inflation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "test/intervention/treated_tube.h"

namespace endovascular_sim::intervention
{
namespace
{

TEST(BalloonInflation, FollowsTheInflatorExponentiallyForAnyStep)
{
  BalloonInflation coarse(balloon());
  coarse.step(0.5, 8.0 * kAtmosphere);
  EXPECT_NEAR(coarse.pressure(), 8.0 * kAtmosphere * (1.0 - std::exp(-1.0)), 1e-3);
  BalloonInflation fine(balloon());
  for (int k = 0; k < 500; ++k)
    fine.step(1e-3, 8.0 * kAtmosphere);
  EXPECT_NEAR(fine.pressure(), coarse.pressure(), 1e-6);
  const double before = coarse.pressure();
  coarse.step(3.0, 0.0);
  EXPECT_NEAR(coarse.pressure(), before * std::exp(-1.0), 1e-3) << "deflation has its own time constant";
}

TEST(BalloonInflation, HasTheChartDiameterBetweenTwoCones)
{
  BalloonInflation inflation(balloon());
  inflation.step(100.0, 8.0 * kAtmosphere);
  EXPECT_NEAR(inflation.diameter(), 3.0e-3, 1e-9);
  EXPECT_NEAR(inflation.radiusAt(12.5e-3), 1.5e-3, 1e-9);
  EXPECT_NEAR(inflation.radiusAt(5e-3), 1.5e-3, 1e-9);
  EXPECT_NEAR(inflation.radiusAt(3.5e-3), 0.75e-3, 1e-9);  // midpoint of a cone of 3 mm
  EXPECT_NEAR(inflation.radiusAt(21.5e-3), 0.75e-3, 1e-9);
  EXPECT_EQ(inflation.radiusAt(inflation.begin()), 0.0);
  EXPECT_EQ(inflation.radiusAt(30e-3), 0.0);
}

TEST(BalloonInflation, ReportsRatedPressureOnceAndRuptures)
{
  BalloonInflation inflation(balloon());
  int above = 0;
  int bursts = 0;
  for (int k = 0; k < 4000; ++k)
  {
    const BalloonInflation::Event event = inflation.step(1e-3, 22.0 * kAtmosphere);
    above += event == BalloonInflation::Event::kAboveRated ? 1 : 0;
    if (event == BalloonInflation::Event::kAboveRated)
    {
      EXPECT_NEAR(inflation.pressure(), 14.0 * kAtmosphere, 0.05 * kAtmosphere);
    }
    bursts += event == BalloonInflation::Event::kBurst ? 1 : 0;
  }
  EXPECT_EQ(above, 1);
  EXPECT_EQ(bursts, 1);
  EXPECT_TRUE(inflation.burst());
  EXPECT_EQ(inflation.pressure(), 0.0) << "a ruptured balloon is empty";
  EXPECT_EQ(inflation.diameter(), 0.9e-3);
  EXPECT_GT(inflation.peakPressure(), 20.0 * kAtmosphere);
}

TEST(BalloonInflation, IsEmptySomeTimeAfterDeflation)
{
  BalloonInflation inflation(balloon());
  inflation.step(10.0, 8.0 * kAtmosphere);
  for (int k = 0; k < 60; ++k)
    inflation.step(1.0, 0.0);
  EXPECT_EQ(inflation.pressure(), 0.0);
}

}  // namespace
}  // namespace endovascular_sim::intervention
