#include "motion/body/motion_settings.h"

#include <fstream>

#include <gtest/gtest.h>

#include "test/common/input_error_of.h"
#include "test/common/temporary_folder.h"
#include "yaml/writer.h"

namespace endovascular_sim::motion
{
namespace
{

class MotionFile : public testing::Test
{
protected:
  std::string errorOf(const std::string& text)
  {
    std::ofstream(folder_.file("own.yaml")) << text;
    return inputErrorOf([this] { readMotion(folder_.file("own.yaml")); });
  }

  TemporaryFolder folder_;
};

std::string yamlOf(MotionSettings motion)
{
  yaml::Writer writer;
  visitMotion(writer, motion);
  return writer.yaml();
}

TEST_F(MotionFile, OfAnAdultHasTheDefaultsThatItStates)
{
  MotionSettings adult = readMotion(PROJECT_DIR "/config/motion/adult.yaml");
  EXPECT_EQ(adult.region.fixed, (std::vector<std::string>{"aortic_arch", "descending_aorta", "abdominal_aorta"}));
  adult.region.fixed.clear();
  EXPECT_NEAR(adult.heart.rate, 70.0 / 60.0, 1e-4);
  adult.heart.rate = MotionSettings().heart.rate;
  EXPECT_EQ(yamlOf(adult), yamlOf(MotionSettings()));
}

TEST_F(MotionFile, IsReadBackAsItIsWritten)
{
  MotionSettings motion = readMotion(PROJECT_DIR "/config/motion/adult.yaml");
  motion.region.base = Eigen::Vector3d(0.01, 0.02, 0.03);
  motion.region.apex = Eigen::Vector3d(0.07, 0.02, -0.03);
  motion.region.centre = Eigen::Vector3d(0.01, -0.02, 0.03);
  motion.region.core = 0.04;
  EXPECT_EQ(errorOf(yamlOf(motion)), "");
  EXPECT_EQ(yamlOf(readMotion(folder_.file("own.yaml"))), yamlOf(motion));
}

TEST_F(MotionFile, IsRefusedForEachNumberThatIsImpossible)
{
  const struct
  {
    const char *map, *key;
    std::vector<const char*> values;
  } rows[] = {{"heart", "rate", {"0", "6.667", "-1", ".nan", "fast"}},  // 0 and 400 beats per minute
              {"heart", "systole", {"0", "-0.4", "2"}},
              {"heart", "systole_per_rate", {"0.1", "-2"}},
              {"heart", "base_displacement", {"-0.01", "0.06", "14"}},
              {"heart", "radial_shortening", {"-0.1", "0.5"}},
              {"heart", "base_rotation", {"1", "-3"}},
              {"heart", "apex_rotation", {"1", "10"}},
              {"breathing", "rate", {"0", "6.667", "-0.2"}},
              {"breathing", "inspiration", {"0", "1"}},
              {"breathing", "translation", {"[0, 0]", "0.005"}},
              {"breathing", "rotation", {"[0.6, 0, 0]"}},
              {"breathing", "diaphragm", {"-0.01", "0.2"}},
              {"region", "fade", {"0.049", "0", "1"}}};
  for (const auto& row : rows)
    for (const char* value : row.values)
    {
      const std::string text = std::string(row.map) + ": {" + row.key + ": " + value + "}";
      const std::string message = errorOf(text);
      EXPECT_NE(message.find(std::string("own.yaml: ") + row.map + "." + row.key + " (line 1): "), std::string::npos)
          << text << ": " << message;
      EXPECT_TRUE(message.find("must be") != std::string::npos || message.find("expected a") != std::string::npos)
          << text << ": " << message;
    }
}

TEST_F(MotionFile, IsRefusedForAmplitudesBeyondTheFade)
{
  EXPECT_NE(
      errorOf("heart: {base_displacement: 0.03}")
          .find("heart.base_displacement (line 1): 0.03 m is beyond the fade, which would fold space; give less than "
                "0.02667, or a larger region.fade than 0.05"),
      std::string::npos)
      << errorOf("heart: {base_displacement: 0.03}");
  EXPECT_EQ(errorOf("{heart: {base_displacement: 0.03}, region: {fade: 0.08}}"), "");
  EXPECT_NE(errorOf("breathing: {translation: [0, 0, -0.04]}").find("breathing.translation (line 1): 0.04 m is beyond"),
            std::string::npos);
}

TEST_F(MotionFile, IsRefusedForCoursesThatDoNotRiseAndFall)
{
  for (const std::string rows :
       {"[[0, 0, 0, 0], [1, 1, 1, 0.9]]", "[[0, 0, 0, 0], [0.9, 1, 1, 1]]", "[[0, 0, 0, 0]]",
        "[[0, 0, 0.1, 0], [1, 1, 1, 1]]", "[[0, 0, 0, 0], [0.5, 0, 0, 0], [0.5, 1, 1, 1], [1, 1, 1, 1]]"})
    EXPECT_NE(errorOf("heart: {contraction: " + rows + "}").find("heart.contraction (line 1): times must ascend"),
              std::string::npos)
        << rows << errorOf("heart: {contraction: " + rows + "}");
  EXPECT_NE(errorOf("heart: {contraction: [[0, 0], [1, 1]]}").find("heart.contraction"), std::string::npos);
  EXPECT_NE(errorOf("breathing: {exhalation: [[0, 0], [1, 1]]}").find("[[0, 1], [1, 0]]"), std::string::npos);
}

TEST_F(MotionFile, IsRefusedForUnknownKeysAndHalfAnAxis)
{
  EXPECT_NE(errorOf("heart: {beats: 70}").find("beats"), std::string::npos);
  EXPECT_NE(errorOf("region: {base: [0, 0, 0]}").find("region.apex"), std::string::npos);
  EXPECT_NE(errorOf("region: {centre: [0, 0, 0]}").find("region.core"), std::string::npos);
  EXPECT_NE(inputErrorOf([] { readMotion("nowhere.yaml"); }).find("config/motion"), std::string::npos);
}

TEST(SystoleOfAHeart, TakesALargerShareOfShorterBeats)
{
  const CardiacMotion heart;
  EXPECT_NEAR(heart.systolicShare(70.0 / 60.0) * 60.0 / 70.0, 0.344, 1e-3);  // [s], 50 ms and an ejection of 294 ms
  EXPECT_LT(heart.systolicShare(1.0), heart.systolicShare(2.0));
  EXPECT_NEAR(heart.systolicShare(3.0) / 3.0, 0.17, 1e-12);  // [s]
  EXPECT_EQ(heart.systolicShare(5.0), 0.6);
}

}  // namespace
}  // namespace endovascular_sim::motion
