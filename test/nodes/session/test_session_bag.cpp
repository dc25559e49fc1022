#include "nodes/session/session_bag.h"

#include <unistd.h>

#include <fstream>

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <topic_tools/shape_shifter.h>

#include "common/hash.h"
#include "common/version.h"
#include "endovascular_sim/SessionEnd.h"
#include "endovascular_sim/SimulationRun.h"
#include "test/common/input_error_of.h"
#include "test/common/temporary_folder.h"

namespace endovascular_sim::nodes
{
namespace
{

/** Bag of a short session without a vessel, in a namespace. */
class SessionBagFile : public testing::Test
{
protected:
  SessionBagFile()
  {
    info_.scene_name = "tube";
    info_.scene_yaml = "name: tube\n";
    Hash64 hash;
    hash.add(info_.scene_yaml);
    info_.scene_hash = hash.value();
    info_.software_version = "0.9.8";
    info_.commit = "0123456789ab";
    info_.physics_number = kPhysicsNumber;
  }

  template <typename Info>
  void write(const Info& info, int steps = 3) const
  {
    rosbag::Bag bag(file_, rosbag::bagmode::Write);
    bag.write("/room/session/info", ros::Time(1.0), info);
    for (int step = 0; step < steps; ++step)
    {
      DriveApplied applied;
      applied.step = static_cast<std::uint64_t>(step);
      bag.write("/room/drive/applied", ros::Time(2.0 + step), applied);
    }
    bag.close();
  }

  /** Serialised info under another type hash, as a bag of another version contains it.
   *  @param omitted number of bytes omitted at the end
   *  @param appended number of bytes appended */
  topic_tools::ShapeShifter infoOfOtherVersion(std::size_t omitted, std::size_t appended) const
  {
    std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(info_));
    ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    ros::serialization::serialize(out, info_);
    bytes.resize(bytes.size() - omitted + appended);
    topic_tools::ShapeShifter message;
    message.morph(std::string(32, '5'), "endovascular_sim/SessionInfo", "string other", "1");
    ros::serialization::IStream in(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    message.read(in);
    return message;
  }

  /** Length of the fields from `commit` on, which earlier versions do not have; the later ones are empty [B]. */
  std::size_t newFields() const
  {
    constexpr std::size_t kPlace = 3 * sizeof(std::uint32_t) + sizeof(std::uint64_t);
    return sizeof(std::uint32_t) + info_.commit.size() + sizeof(std::int32_t) + kPlace;
  }

  std::string refusal() const
  {
    return inputErrorOf([&] { readSessionBag(file_); });
  }

  TemporaryFolder folder_;
  const std::string file_ = folder_.file("session.bag");
  SessionInfo info_;
};

TEST_F(SessionBagFile, IsReadInAnyNamespace)
{
  write(info_);
  const SessionBag session = readSessionBag(file_);
  EXPECT_EQ(session.info.scene_name, "tube");
  EXPECT_EQ(session.steps.size(), 3U);
  EXPECT_FALSE(session.mesh);
}

TEST_F(SessionBagFile, IsRefusedWithAnotherPhysicsNumberAndTheErrorNamesVersionAndCommit)
{
  info_.physics_number = kPhysicsNumber + 1;
  write(info_);
  const std::string error = refusal();
  EXPECT_NE(error.find("physics " + std::to_string(kPhysicsNumber + 1)), std::string::npos) << error;
  EXPECT_NE(error.find("version 0.9.8"), std::string::npos) << error;
  EXPECT_NE(error.find("build of commit 0123456789ab"), std::string::npos) << error;
  EXPECT_NE(error.find("this program has physics " + std::to_string(kPhysicsNumber)), std::string::npos) << error;
}

TEST_F(SessionBagFile, IsRefusedWithoutAPhysicsNumberAndTheErrorNamesTheVersion)
{
  write(infoOfOtherVersion(newFields(), 0));
  const std::string error = refusal();
  EXPECT_NE(error.find("no physics number"), std::string::npos) << error;
  EXPECT_NE(error.find("replay it with version 0.9.8"), std::string::npos) << error;
}

TEST_F(SessionBagFile, IsReadWithEqualPhysicsAndFurtherFields)
{
  write(infoOfOtherVersion(0, 8));
  EXPECT_EQ(readSessionBag(file_).info.scene_yaml, info_.scene_yaml);
}

TEST_F(SessionBagFile, IsRefusedWithoutSessionInfo)
{
  rosbag::Bag bag(file_, rosbag::bagmode::Write);
  bag.write("/drive/applied", ros::Time(1.0), DriveApplied());
  bag.close();
  EXPECT_NE(refusal().find("session/info: missing"), std::string::npos) << refusal();
}

TEST_F(SessionBagFile, IsRefusedWithAChangedScene)
{
  info_.scene_yaml += "seed: 5\n";
  write(info_);
  EXPECT_NE(refusal().find("does not match its hash"), std::string::npos) << refusal();
}

TEST_F(SessionBagFile, OfALoadedStateIsCompleteFromItsFirstStepOn)
{
  write(info_, 0);
  {
    rosbag::Bag bag(file_, rosbag::bagmode::Append);
    SimulationRun run;
    run.run = 2;
    run.first_step = 5;
    run.state = {'s', 't'};
    bag.write("/room/simulation/run", ros::Time(1.5), run);
    for (std::uint64_t step = 5; step < 8; ++step)
    {
      DriveApplied applied;
      applied.step = step;
      bag.write("/room/drive/applied", ros::Time(2.0), applied);
    }
    SessionEnd end;
    end.steps = 8;
    bag.write("/room/session/end", ros::Time(3.0), end);
  }
  SessionBag session = readSessionBag(file_);
  EXPECT_EQ(session.first_step, 5U);
  EXPECT_EQ(session.state, "st");
  EXPECT_EQ(incompleteness(session), "");
  session.steps.erase(6);
  EXPECT_EQ(incompleteness(session), "the bag holds 2 of the session's 3 steps");
}

TEST_F(SessionBagFile, IsIncompleteWithoutAnEnd)
{
  write(info_);
  EXPECT_NE(incompleteness(readSessionBag(file_)).find("no end"), std::string::npos);
}

TEST_F(SessionBagFile, IsRefusedWithReasonAndRemedyWhenItIsNoBag)
{
  EXPECT_NE(refusal().find("cannot be read (No such file or directory); give"), std::string::npos) << refusal();
  std::ofstream(file_) << "seed: 1\n";
  EXPECT_NE(refusal().find("is no bag of version 2.0; give"), std::string::npos) << refusal();
}

TEST_F(SessionBagFile, IsRefusedWithoutSteps)
{
  write(info_, 0);
  EXPECT_NE(refusal().find("no step"), std::string::npos) << refusal();
}

}  // namespace
}  // namespace endovascular_sim::nodes
