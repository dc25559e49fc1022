#include "nodes/player/bag_timeline.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "nodes/session/session_bag.h"
#include "nodes/session/session_files.h"
#include "test/common/input_error_of.h"
#include "test/nodes/player/played_session.h"

namespace endovascular_sim::nodes
{
namespace
{

class Timeline : public testing::Test
{
protected:
  static std::string bytesOf(const BagMessage& message)
  {
    return {reinterpret_cast<const char*>(message.data), message.size};
  }

  /** Bytes of the last message of a topic at or before a time, by rosbag. @param frame of /tf; empty: any message */
  std::string expected(const std::string& topic, ros::Time time, const std::string& frame = "") const
  {
    rosbag::Bag bag(file);
    std::string newest;
    for (const rosbag::MessageInstance& message : rosbag::View(bag, rosbag::TopicQuery(topic), ros::TIME_MIN, time))
    {
      if (!frame.empty() && message.instantiate<tf2_msgs::TFMessage>()->transforms.front().child_frame_id != frame)
        continue;
      newest.resize(message.size());
      ros::serialization::OStream out(reinterpret_cast<std::uint8_t*>(newest.data()), message.size());
      message.write(out);
    }
    return newest;
  }

  bool names(const BagTimeline& timeline, const std::string& text) const
  {
    for (const std::string& missing : timeline.missing())
      if (missing.find(text) != std::string::npos)
        return true;
    return false;
  }

  TemporaryFolder folder;
  const std::string file = folder.file("session.bag");
};

TEST_F(Timeline, GivesAtAnyTimeTheLastMessageOfEveryTopicByteForByte)
{
  const PlayedSession session(file);
  const BagTimeline timeline({file});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(0.0, 9.9);
  int compared = 0;
  for (int k = 0; k < 20; ++k)
  {
    const ros::Time time = timeline.states()[timeline.stateAtTime(any(random))].end;
    for (std::size_t stream = 0; stream < timeline.streams().size(); ++stream)
    {
      const auto entry = timeline.newest(stream, time);
      const RecordedTopic& topic = timeline.topics()[timeline.streams()[stream].topic];
      std::string frame;
      if (topic.name == "/tf" || topic.name == "/tf_static")
        frame = timeline.message(timeline.streams()[stream].entries.front())
                    .read<tf2_msgs::TFMessage>()
                    ->transforms.front()
                    .child_frame_id;
      const std::string wanted = expected(topic.name, time, frame);
      ASSERT_EQ(entry.has_value(), !wanted.empty()) << topic.name;
      if (!entry)
        continue;
      EXPECT_EQ(bytesOf(timeline.message(*entry)), wanted) << topic.name << " " << frame;
      ++compared;
    }
  }
  EXPECT_GT(compared, 150);
}

TEST_F(Timeline, FindsTheStateOfATimeAndOfAStep)
{
  const PlayedSession session(file);
  const BagTimeline timeline({file});
  ASSERT_EQ(timeline.states().size(), 100U);
  EXPECT_EQ(timeline.stateAtTime(-5.0), 0U);
  EXPECT_EQ(timeline.stateAtTime(0.1), 1U);
  EXPECT_EQ(timeline.stateAtTime(0.1999), 1U);
  EXPECT_EQ(timeline.stateAtTime(1e9), 99U);
  EXPECT_EQ(timeline.stateAtStep(0), 0U);
  EXPECT_EQ(timeline.stateAtStep(1234), 12U);
  EXPECT_EQ(timeline.stateAt(PlayedSession::timeOf(7)), 7U);
}

TEST_F(Timeline, CountsTheBalloonsOfAStepAsPartOfItsState)
{
  const PlayedSession session(file);
  const BagTimeline timeline({file});
  for (const RecordedState& state : timeline.states())
    EXPECT_NEAR((state.end - state.time).toSec(), 0.002, 1e-6);
}

TEST_F(Timeline, NamesNothingOfACompleteBag)
{
  const PlayedSession session(file);
  const BagTimeline timeline({file});
  EXPECT_TRUE(timeline.missing().empty()) << timeline.missing().front();
  ASSERT_TRUE(timeline.info());
  EXPECT_EQ(timeline.info()->scene_name, "small");
}

TEST_F(Timeline, PlaysABagThatIsCutOffUpToItsEnd)
{
  const PlayedSession session(file);
  const std::string whole = contentOf(file);
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      << whole.substr(0, whole.size() * 3 / 10);  // the index is large
  const BagTimeline timeline({file});
  EXPECT_GT(timeline.states().size(), 10U);
  EXPECT_LT(timeline.states().size(), 90U);
  EXPECT_TRUE(names(timeline, "damaged"));
  EXPECT_TRUE(names(timeline, "the end of the session"));
}

TEST_F(Timeline, PlaysABagWithAHoleAroundIt)
{
  const PlayedSession session(file);
  std::string damaged = contentOf(file);
  std::memset(&damaged[damaged.size() / 2], 0, 300);
  std::ofstream(file, std::ios::binary | std::ios::trunc) << damaged;
  const BagTimeline timeline({file});
  EXPECT_GT(timeline.states().size(), 10U);
  EXPECT_TRUE(names(timeline, "damaged"));
  for (std::size_t entry = 0; entry < timeline.entries().size(); ++entry)
    EXPECT_NO_THROW(timeline.message(entry));
}

TEST_F(Timeline, LeavesOutATopicOfAnotherVersionAndNamesIt)
{
  PlayedFaults faults;
  faults.with_steps_of_another = true;
  const PlayedSession session(file, faults);
  const BagTimeline timeline({file});
  EXPECT_TRUE(names(timeline, "/room/procedure/step has the fields of another version"));
  EXPECT_EQ(timeline.topic("procedure/step"), nullptr);
  EXPECT_EQ(timeline.states().size(), 100U);
}

TEST_F(Timeline, PlaysABagWithoutItsSceneAndSaysSo)
{
  PlayedFaults faults;
  faults.without_info = true;
  const PlayedSession session(file, faults);
  const BagTimeline timeline({file});
  EXPECT_FALSE(timeline.info());
  EXPECT_TRUE(names(timeline, "session/info"));
}

TEST_F(Timeline, JoinsTheBagsOfARecordingThatWasContinued)
{
  PlayedFaults first, second;
  first.last = 40;
  first.without_end = true;
  second.first = 45;
  const PlayedSession begin(file, first), end(folder.file("session_2.bag"), second);
  const BagTimeline timeline({end.file(), begin.file()});
  EXPECT_EQ(timeline.files(), (std::vector<std::string>{begin.file(), end.file()}));
  EXPECT_EQ(timeline.states().size(), 40U + 55U);
  EXPECT_TRUE(names(timeline, "no state between the steps 3900 and 4500"));
  EXPECT_EQ(bagsOfOneSession({folder.path().string()}), timeline.files());
}

TEST_F(Timeline, ShowsTheLastOfStatesThatWereRecordedAtOneTime)
{
  PlayedFaults faults;
  faults.late = 5;
  const PlayedSession session(file, faults);
  const BagTimeline timeline({session.file()});
  EXPECT_EQ(timeline.states().size(), 96U);
  EXPECT_EQ(timeline.states().front().step, PlayedSession::stepOf(4));
  EXPECT_TRUE(timeline.missing().empty());
}

TEST_F(Timeline, RefusesBagsOfDifferentRuns)
{
  const PlayedSession session(file), other(folder.file("other.bag"));
  const std::string error = inputErrorOf([&] { BagTimeline({file, other.file()}); });
  EXPECT_NE(error.find("another run"), std::string::npos) << error;
}

TEST_F(Timeline, RefusesWhatHoldsNoState)
{
  PlayedFaults faults;
  faults.last = 0;
  const PlayedSession session(file, faults);
  EXPECT_NE(inputErrorOf([&] { BagTimeline({file}); }).find("no state that can be shown"), std::string::npos);
  EXPECT_NE(inputErrorOf([&] { BagTimeline({folder.file("none.bag")}); }).find("cannot be read"), std::string::npos);
  std::ofstream(file, std::ios::trunc) << "name: scene\n";
  EXPECT_NE(inputErrorOf([&] { BagTimeline({file}); }).find("is no bag"), std::string::npos);
  std::filesystem::create_directory(folder.path() / "empty");
  EXPECT_NE(inputErrorOf([&] { bagsOfOneSession({folder.file("empty")}); }).find("holds no bag"), std::string::npos);
}

}  // namespace
}  // namespace endovascular_sim::nodes
