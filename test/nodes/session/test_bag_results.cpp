#include "nodes/session/bag_results.h"

#include <fstream>
#include <regex>
#include <sstream>

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <nlohmann/json.hpp>

#include "common/hash.h"
#include "test/common/input_error_of.h"
#include "test/common/temporary_folder.h"
#include "test/fuzz/small_session_bag.h"

namespace endovascular_sim::nodes
{
namespace
{

using Json = nlohmann::ordered_json;

/** Session that an earlier version recorded, with the metrics that its session node wrote. */
constexpr auto kFormerBag = TEST_DATA_DIR "/recorded_session/session.bag";
constexpr auto kFormerMetrics = TEST_DATA_DIR "/recorded_session/metrics.json";

Json jsonOf(const std::string& file)
{
  std::ifstream stream(file);
  return Json::parse(stream);
}

class ResultsOfBags : public testing::Test
{
protected:
  std::string out(const std::string& name) const { return folder_.file("out/" + name); }

  TemporaryFolder folder_;
};

TEST_F(ResultsOfBags, OfAnEarlierVersionAreThoseThatItWrote)
{
  const BagResultFiles files = writeResults({kFormerBag}, folder_.file("out"), false);
  EXPECT_EQ(files.left_out, 0U);
  const Json made = jsonOf(out("metrics.json"));
  std::ostringstream former;
  former << std::ifstream(kFormerMetrics).rdbuf();
  const Json recorded = Json::parse(std::regex_replace(former.str(), std::regex("new_tries"), "retries"));
  // Keys that later versions added are not in the former file.
  for (const auto& [key, value] : recorded.items())
    if (made.contains(key) && key != "errors" && key != "marks")
    {
      EXPECT_EQ(made[key].dump(), value.dump()) << key;
    }
}

TEST_F(ResultsOfBags, NameTheProgramThatRecorded)
{
  writeResults({kFormerBag}, folder_.file("out"), false);
  const BagOutline outline = outlineOf(kFormerBag);
  ASSERT_TRUE(outline.info);
  const Json report = jsonOf(out("report.json"));
  EXPECT_EQ(report["commit"], outline.info->commit);
  EXPECT_EQ(report["physics"], outline.info->physics_number);
  EXPECT_EQ(report["scene"]["hash"], Hash64::toHex(outline.info->scene_hash));
  EXPECT_EQ(report["recording"]["messages"], outline.messages);
}

TEST_F(ResultsOfBags, OfASmallSessionCountItsSteps)
{
  const std::string bag = folder_.file("session.bag");
  fuzz::writeSmallSession(bag, rosbag::compression::LZ4);
  const BagResultFiles files = writeResults({bag}, folder_.file("out"), true);
  EXPECT_TRUE(files.is_complete);
  const Json report = jsonOf(out("report.json"));
  EXPECT_EQ(report["steps"], fuzz::kSessionSteps);
  EXPECT_EQ(report["steps_missing_from_recording"], 0);
  EXPECT_TRUE(report["error"].is_null());
}

TEST_F(ResultsOfBags, WithoutAnEndAreNotComplete)
{
  const std::string bag = folder_.file("session.bag");
  fuzz::writeSmallSession(bag, rosbag::compression::LZ4);
  std::ostringstream content;
  content << std::ifstream(bag, std::ios::binary).rdbuf();
  const std::string cut = folder_.file("cut.bag");
  std::ofstream(cut, std::ios::binary) << content.str().substr(0, content.str().size() - 200);
  const BagResultFiles files = writeResults({cut}, folder_.file("out"), true);
  EXPECT_FALSE(files.is_complete);
  EXPECT_EQ(files.damage.size(), 1U);
}

TEST_F(ResultsOfBags, AreRefusedWithoutSessionInfo)
{
  const std::string file = folder_.file("other.bag");
  {
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    bag.write("/drive/applied", ros::Time(1.0), DriveApplied());
  }
  const std::string error = inputErrorOf([&] { writeResults({file}, folder_.file("out"), true); });
  EXPECT_NE(error.find(file), std::string::npos) << error;
  EXPECT_NE(error.find("session/info"), std::string::npos) << error;
}

}  // namespace
}  // namespace endovascular_sim::nodes
