#include "nodes/rod_dynamics/instruments/grip_watch.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kStep = 1e-3;  // s

/** Grip with a slip in the insertion. */
class Bench
{
public:
  void run(double seconds, double slip_speed, double load = 0.5)
  {
    for (int k = 0; k < std::lround(seconds / kStep); ++k)
      watch.addStep({slipped_ += slip_speed * kStep, 0.0}, {load, 0.0}, kStep);
  }

  GripWatch watch;

private:
  double slipped_ = 0.0;
};

TEST(GripWatch, WarnsOfASlipOfASecondOnly)
{
  Bench bench;
  bench.run(0.9, 0.05);
  EXPECT_EQ(bench.watch.warning(), "");
  bench.run(0.2, 0.05);
  EXPECT_NE(bench.watch.warning().find("slips in the insertion"), std::string::npos);
  EXPECT_EQ(bench.watch.changes(), 1U);
}

TEST(GripWatch, WarnsOfAnInstrumentThatWaitsAtAStop)
{
  GripWatch watch;
  for (int k = 0; k < 1100; ++k)
    watch.addStep({0.0, 0.0}, {0.0, 0.0}, kStep, true);
  EXPECT_NE(watch.warning().find("waits at a stop"), std::string::npos);
}

TEST(GripWatch, WarnsWhereAChuckStandsAtItsForceLimit)
{
  Bench bench;
  bench.run(1.1, 0.0, -1.0);
  EXPECT_NE(bench.watch.warning(), "");
}

TEST(GripWatch, EndsTheWarningASecondAfterTheSlip)
{
  Bench bench;
  bench.run(2.0, 0.05);
  bench.run(0.8, 0.0);
  EXPECT_NE(bench.watch.warning(), "") << "short rests occur while one pushes to and fro";
  bench.run(0.3, 0.0);
  EXPECT_EQ(bench.watch.warning(), "");
}

TEST(GripWatch, IsSilentForAFirmGripAndForShortSlips)
{
  Bench bench;
  bench.run(5.0, 0.0);
  for (int k = 0; k < 5; ++k)
  {
    bench.run(0.5, 0.05);
    bench.run(0.5, 0.0);
  }
  EXPECT_EQ(bench.watch.changes(), 0U);
}

}  // namespace
}  // namespace endovascular_sim::nodes
