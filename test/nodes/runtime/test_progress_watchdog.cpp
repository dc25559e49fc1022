#include "nodes/runtime/progress_watchdog.h"

#include <gtest/gtest.h>

#include "nodes/rod_dynamics/step_statistics.h"

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
    // On a loaded machine a test is never busy: each observation without progress counts.
    const ProgressWatchdog watchdog(
        progress, 1, [&given_up] { ++given_up; }, StallCriterion(0.0));
    while (given_up == 0)  // the test's time-out ends it when the watchdog fails
      std::this_thread::yield();
  }
  EXPECT_EQ(given_up, 1);
}

TEST(ProgressWatchdog, MarksTheGrantAndItsCopiesAsWithdrawnForDiagnostics)
{
  const std::atomic<unsigned long> progress{1};
  std::atomic<int> withdrawals{0};
  SchedulingGrant grant;
  grant.message = "SCHED_FIFO, priority 1";
  const auto watchdog = superviseScheduling(
      grant, progress, 1, [&withdrawals] { ++withdrawals; }, StallCriterion(0.0));
  const SchedulingGrant copy = grant;  // as a node retains it
  while (copy.isInForce())             // the test's time-out ends it when the watchdog fails
    std::this_thread::yield();
  EXPECT_EQ(withdrawals, 1);
  EXPECT_NE(copy.describe().find("withdrawn"), std::string::npos) << copy.describe();

  diagnostic_updater::DiagnosticStatusWrapper status;
  StepStatistics(1e-3).diagnose(copy, status);
  EXPECT_EQ(status.level, diagnostic_msgs::DiagnosticStatus::WARN);
  EXPECT_NE(status.message.find("withdrawn"), std::string::npos) << status.message;
  EXPECT_EQ(status.values.at(0).key, "scheduling");
  EXPECT_NE(status.values.at(0).value.find("withdrawn"), std::string::npos) << status.values.at(0).value;
}

}  // namespace
}  // namespace endovascular_sim::nodes
