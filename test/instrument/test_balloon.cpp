#include "instrument/balloon.h"

#include <gtest/gtest.h>

namespace endovascular_sim::instrument
{
namespace
{

Balloon balloon()
{
  Balloon result;
  result.folded_diameter = 0.9e-3;
  result.compliance = {{2e5, 2.2e-3}, {8e5, 2.5e-3}, {14e5, 2.7e-3}};
  result.nominal_pressure = 8e5;
  return result;
}

TEST(Balloon, InterpolatesTheComplianceChart)
{
  EXPECT_DOUBLE_EQ(balloon().diameterAt(2e5), 2.2e-3);
  EXPECT_DOUBLE_EQ(balloon().diameterAt(5e5), 2.35e-3);
  EXPECT_DOUBLE_EQ(balloon().nominalDiameter(), 2.5e-3);
  EXPECT_DOUBLE_EQ(balloon().diameterAt(14e5), 2.7e-3);
}

TEST(Balloon, IsFoldedWithoutPressureAndUnfoldsTowardsTheFirstRow)
{
  EXPECT_EQ(balloon().diameterAt(0.0), 0.9e-3);
  EXPECT_EQ(balloon().diameterAt(-1e5), 0.9e-3);
  EXPECT_DOUBLE_EQ(balloon().diameterAt(1e5), 1.55e-3);
}

TEST(Balloon, ExtrapolatesBeyondTheChart)
{
  EXPECT_DOUBLE_EQ(balloon().diameterAt(20e5), 2.9e-3);
}

TEST(Balloon, GrowsContinuouslyWithPressure)
{
  double before = balloon().diameterAt(-1e5);
  for (double pressure = -1e5; pressure < 20e5; pressure += 1e3)
  {
    const double diameter = balloon().diameterAt(pressure);
    EXPECT_GE(diameter, before);
    EXPECT_LT(diameter - before, 1e-5);
    before = diameter;
  }
}

}  // namespace
}  // namespace endovascular_sim::instrument
