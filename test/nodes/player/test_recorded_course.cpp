#include "nodes/player/recorded_course.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "test/nodes/player/played_session.h"

namespace endovascular_sim::nodes
{
namespace
{

class Course : public testing::Test
{
protected:
  TemporaryFolder folder;
  const PlayedSession session{folder.file("session.bag")};
  const BagTimeline timeline{{session.file()}};
  const RecordedCourse course{timeline};
};

TEST_F(Course, HasTheStepsTheErrorsAndTheRemarksAsChapters)
{
  const std::vector<PlayerChapter>& chapters = course.chapters();
  ASSERT_EQ(chapters.size(), 6U);
  EXPECT_EQ(chapters[0].name, "Phase 0, advance wire");
  EXPECT_EQ(chapters[1].time, 2.5);
  EXPECT_EQ(chapters[3].kind, PlayerChapter::ERROR);
  EXPECT_EQ(chapters[3].name, "wrong branch");
  EXPECT_EQ(chapters[4].kind, PlayerChapter::MARK);
  EXPECT_EQ(chapters[4].name, "look here");
  EXPECT_NEAR(chapters[4].time, 5.5, 1e-12);
  EXPECT_TRUE(course.missing().empty()) << course.missing().front();
}

TEST_F(Course, KnowsTheLargestForcesUpToEachState)
{
  EXPECT_EQ(course.peakHandForce(39), std::vector<double>{0.5});
  EXPECT_EQ(course.peakHandForce(40), std::vector<double>{2.0});
  EXPECT_EQ(course.peakHandForce(60), std::vector<double>{2.0}) << "the sample after the state is not yet over";
  EXPECT_EQ(course.peakHandForce(61), std::vector<double>{3.0});
  EXPECT_NEAR(course.peakNodeForce(29), 0.01, 1e-12);
  EXPECT_NEAR(course.peakNodeForce(99), 0.3, 1e-12);
}

TEST_F(Course, KnowsTheViewOfTheCArm)
{
  EXPECT_EQ(course.viewAt(PlayedSession::timeOf(32)), "");
  EXPECT_EQ(course.viewAt(PlayedSession::timeOf(33)), "LAO 40");
  EXPECT_EQ(course.viewAt(PlayedSession::timeOf(99)), "LAO 40");
}

}  // namespace
}  // namespace endovascular_sim::nodes
