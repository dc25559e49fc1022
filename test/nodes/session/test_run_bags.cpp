#include "nodes/session/run_bags.h"

#include <filesystem>

#include <gtest/gtest.h>
#include <rosbag/bag.h>

#include "endovascular_sim/DriveApplied.h"
#include "endovascular_sim/SessionEnd.h"
#include "nodes/session/bag_survey.h"
#include "test/common/temporary_folder.h"

namespace endovascular_sim::nodes
{
namespace
{

/** Folder with the bags of a run. */
class BagsOfARun : public testing::Test
{
protected:
  /** Writes steps 0 to 2. @param closes false: the bag is copied before its end, as a killed process leaves it */
  void write(const std::string& name, bool closes) const
  {
    const std::string open = folder_.file("open");
    rosbag::Bag bag(open, rosbag::bagmode::Write);
    for (std::uint64_t step = 0; step < 3; ++step)
    {
      DriveApplied applied;
      applied.step = step;
      bag.write("/room/drive/applied", ros::Time(1.0), applied);
    }
    bag.setChunkThreshold(1);  // ends the chunk
    if (!closes)
      std::filesystem::copy_file(open, folder_.file(name));
    bag.close();
    if (closes)
      std::filesystem::copy_file(open, folder_.file(name));
    std::filesystem::remove(open);
  }

  TemporaryFolder folder_;
};

TEST_F(BagsOfARun, AreNumberedAfterTheFirstOne)
{
  EXPECT_EQ(RunBags(folder_.path().string()).nextName(), "session.bag");
  write("session.bag", true);
  write("session_2.bag", true);
  const RunBags bags(folder_.path().string());
  EXPECT_EQ(bags.names(), (std::vector<std::string>{"session.bag", "session_2.bag"}));
  EXPECT_EQ(bags.nextName(), "session_3.bag");
}

TEST_F(BagsOfARun, ThatWasKilledIsCompletedWithItsGapAndItsEnd)
{
  ros::Time::init();  // no node runs
  write("session.bag", false);
  EXPECT_FALSE(surveyBag(folder_.file("session.bag")).damage.empty());
  const RunBags bags(folder_.path().string());
  EXPECT_EQ(bags.steps(), 3U);
  SessionGap gap;
  gap.first_step = 3;
  gap.last_step = 7;
  gap.previous = bags.lastName();
  gap.next = bags.nextName();
  bags.complete("/room/", &gap);
  const BagSurvey survey = surveyBag(folder_.file("session.bag"));
  EXPECT_EQ(survey.damage, "");
  EXPECT_EQ(survey.steps, 3U);
  EXPECT_EQ(survey.recorded_steps, 3U);
  ASSERT_EQ(survey.outer_gaps.size(), 1U);
  EXPECT_EQ(survey.outer_gaps[0].last_step, 7U);
  EXPECT_TRUE(survey.topics.at("/room/session/gap").is_latched);
  EXPECT_EQ(RunBags(folder_.path().string()).steps(), 3U);
}

TEST_F(BagsOfARun, WithoutAStepAndFilesThatAreNoBagCountAsNone)
{
  write("session.bag", true);
  {
    rosbag::Bag empty(folder_.file("session_2.bag"), rosbag::bagmode::Write);
  }
  std::ofstream(folder_.file("session_3.bag")) << "no bag";
  const RunBags bags(folder_.path().string());
  EXPECT_EQ(bags.lastName(), "session.bag");
  EXPECT_EQ(bags.nextName(), "session_4.bag");
}

}  // namespace
}  // namespace endovascular_sim::nodes
