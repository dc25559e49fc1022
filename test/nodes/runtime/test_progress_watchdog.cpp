#include "nodes/runtime/progress_watchdog.h"

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

TEST(StallCriterion, HoldsForABusyLoopWithoutProgress)
{
  StallCriterion criterion;
  EXPECT_FALSE(criterion.observe(7, 1.0));  // the first observation sees progress
  for (int k = 1; k < StallCriterion::kObservations; ++k)
    EXPECT_FALSE(criterion.observe(7, 1.0));
  EXPECT_TRUE(criterion.observe(7, 1.0));
}

TEST(StallCriterion, NeverHoldsForAnOverloadedLoopThatProgresses)
{
  StallCriterion criterion;
  for (unsigned long k = 1; k < 1000; ++k)
    EXPECT_FALSE(criterion.observe(k, 1.0));
}

TEST(StallCriterion, NeverHoldsForAProcessThatWaits)
{
  StallCriterion criterion;
  for (int k = 0; k < 1000; ++k)
    EXPECT_FALSE(criterion.observe(7, 0.1));
}

TEST(StallCriterion, StartsAnewAfterProgress)
{
  StallCriterion criterion;
  unsigned long progress = 1;
  for (int round = 0; round < 10; ++round, ++progress)
    for (int k = 0; k < StallCriterion::kObservations; ++k)
      EXPECT_FALSE(criterion.observe(progress, 1.0));
}

TEST(ProgressWatchdog, GivesUpOnceForALoopWithoutProgress)
{
  const std::atomic<unsigned long> progress{1};
  std::atomic<int> given_up{0};
  {
    const ProgressWatchdog watchdog(progress, 1, [&given_up] { ++given_up; });
    while (given_up == 0)  // the busy loop; the test's time-out ends it when the watchdog fails
    {
    }
  }
  EXPECT_EQ(given_up, 1);
}

}  // namespace
}  // namespace endovascular_sim::nodes
