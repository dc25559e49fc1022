#include "rviz_plugin/model/error_watch.h"

#include <gtest/gtest.h>

namespace endovascular_sim::rviz_plugin
{
namespace
{

ProcedureStep step(unsigned begun, unsigned wrong_branches = 0, std::uint8_t outcome = ProcedureStep::RUNNING)
{
  ProcedureStep step;
  step.begun = begun;
  step.wrong_branches = wrong_branches;
  step.outcome = outcome;
  return step;
}

TEST(ErrorWatch, NamesEachWrongBranchOnce)
{
  ErrorWatch watch;
  EXPECT_EQ(watch.follow(step(1), "left renal"), "");
  EXPECT_EQ(watch.follow(step(1, 1), "left renal"), "Wrong branch: left renal; pull back, twist, push");
  EXPECT_EQ(watch.follow(step(1, 1), "left renal"), "");
  EXPECT_EQ(watch.follow(step(1, 2), ""), "Wrong branch; pull back, twist, push");
  EXPECT_EQ(watch.follow(step(2, 0), "aortic arch"), "") << "the next step counts anew";
  EXPECT_NE(watch.follow(step(2, 1), "left subclavian"), "");
}

TEST(ErrorWatch, NamesALossOfSupportAndAFailure)
{
  ErrorWatch watch;
  watch.follow(step(1), "");
  EXPECT_EQ(watch.follow(step(1, 0, ProcedureStep::LOST), ""), "Support lost: an earlier step is repeated");
  EXPECT_EQ(watch.follow(step(1, 0, ProcedureStep::LOST), ""), "");
  ProcedureStep failed = step(2, 0, ProcedureStep::FAILED);
  failed.failure = "no progress";
  EXPECT_EQ(watch.follow(failed, ""), "Step failed: no progress");
  EXPECT_EQ(watch.follow(step(3, 0, ProcedureStep::DONE), ""), "");
}

TEST(ErrorWatch, NamesEachErrorOfTheMetricsOnce)
{
  ErrorWatch watch;
  SessionProgress progress;
  progress.run = 1;
  EXPECT_EQ(watch.follow(progress), "");
  progress.errors = 1;
  progress.last_error = "risk of perforation: wire, 0.7 N";
  EXPECT_EQ(watch.follow(progress), "Error: risk of perforation: wire, 0.7 N");
  EXPECT_EQ(watch.follow(progress), "");
  progress.run = 2;  // after a reset
  progress.errors = 0;
  EXPECT_EQ(watch.follow(progress), "");
  progress.errors = 1;
  EXPECT_NE(watch.follow(progress), "");
}

TEST(ErrorWatch, AWrongBranchIsOverWhenTheTipHasLeftItOrTheStepIsDone)
{
  ErrorWatch watch;
  watch.follow(step(1), "aortic arch");
  EXPECT_FALSE(watch.isOver("aortic arch")) << "no error";
  watch.follow(step(1, 1), "brachiocephalic");
  EXPECT_FALSE(watch.isOver("brachiocephalic"));
  EXPECT_FALSE(watch.isOver("")) << "the tip's branch is unknown";
  EXPECT_TRUE(watch.isOver("aortic arch"));
  watch.follow(step(1, 1, ProcedureStep::DONE), "brachiocephalic");
  EXPECT_TRUE(watch.isOver("brachiocephalic"));
  SessionProgress progress;
  progress.errors = 1;
  watch.follow(progress);
  EXPECT_FALSE(watch.isOver("aortic arch")) << "a newer error of another kind remains";
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
