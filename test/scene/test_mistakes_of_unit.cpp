#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "common/error.h"
#include "scene/instrument_library.h"
#include "scene/numeric_keys.h"
#include "scene/scene_file.h"

namespace endovascular_sim::scene
{
namespace
{

const std::string kProject = PROJECT_DIR;
const std::string kBench = TEST_DATA_DIR "/scenes/good_bench.yaml";

/** Warnings of a scene with a changed value, or the message of its rejection. */
std::string judge(const std::string& file, const std::string& change)
{
  try
  {
    std::string text;
    for (const std::string& warning : loadScene(file, {change}).warnings)
      text += "warning: " + warning + "\n";
    return text;
  }
  catch (const InputError& error)
  {
    return std::string("rejected: ") + error.what();
  }
}

struct Mistake
{
  const char* scene;
  const char* change;
  const char* key;
  const char* question;
};

const std::vector<Mistake> kMistakes = {
    {"demo", "solver.time_step=1e-9", "solver.time_step", "time steps are in s"},
    {"demo", "loads.gravity=[0,0,-9810]", "loads.gravity", "did you mean -9810 mm/s² = -9.81 m/s²?"},
    {"demo", "drive.force_limit=5000", "drive.force_limit", "did you mean 5000 mN = 5 N?"},
    {"demo", "drive.speed=30", "drive.speed", "did you mean 30 mm/s = 0.03 m/s?"},
    {"demo", "vessel.friction=20000", "vessel.friction", "friction coefficients are usually"},
    {"demo", "fluoroscopy.source_to_detector=1200", "fluoroscopy.source_to_detector", "did you mean 1200 mm = 1.2 m?"},
};

TEST(MistakesOfUnit, InAnySceneNameKeyAndLikelyUnit)
{
  for (const Mistake& mistake : kMistakes)
  {
    const std::string message = judge(kProject + "/config/scenes/" + mistake.scene + ".yaml", mistake.change);
    EXPECT_NE(message.find(mistake.key), std::string::npos) << mistake.change << ": " << message;
    EXPECT_NE(message.find(mistake.question), std::string::npos) << mistake.change << ": " << message;
  }
}

TEST(MistakesOfUnit, InAWireNameKeyAndLikelyUnit)
{
  const std::vector<Mistake> mistakes = {
      {"", "instrument.sections.0.density=6.45", "sections.0.density", "did you mean 6.45 g/cm³ = 6450 kg/m³?"},
      {"", "instrument.sections.0.bending_stiffness=300", "sections.0.bending_stiffness", "N·mm² = 0.0003 N·m²?"},
      {"", "instrument.sections.0.radius=0.45", "sections.0.radius", "did you mean 0.45 mm = 0.00045 m?"},
  };
  for (const Mistake& mistake : mistakes)
  {
    const std::string message = judge(kBench, mistake.change);
    EXPECT_NE(message.find(mistake.key), std::string::npos) << mistake.change << ": " << message;
    EXPECT_NE(message.find(mistake.question), std::string::npos) << mistake.change << ": " << message;
  }
}

TEST(MistakesOfUnit, OfABalloonNameKeyAndLikelyUnit)
{
  const std::string message =
      judge(kProject + "/config/scenes/stent.yaml", "instruments.1.instrument.balloon.nominal_pressure=12");
  EXPECT_NE(message.find("nominal_pressure"), std::string::npos) << message;
  EXPECT_NE(message.find("did you mean 12 atm"), std::string::npos) << message;
}

TEST(MistakesOfUnit, FarOutsideTheUsualValuesAreRejectedAndOthersWarn)
{
  const std::string file = kProject + "/config/scenes/demo.yaml";
  EXPECT_EQ(judge(file, "drive.force_limit=5000").rfind("rejected: ", 0), 0U);
  EXPECT_EQ(judge(file, "drive.force_limit=200").rfind("warning: ", 0), 0U);
  EXPECT_EQ(judge(file, "drive.force_limit=4"), "");
}

TEST(MistakesOfUnit, DoNotOccurInTheShippedFiles)
{
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kProject + "/config/scenes"))
  {
    if (entry.path().extension() != ".yaml")
      continue;
    try
    {
      for (const std::string& warning : loadScene(entry.path().string()).warnings)
        ADD_FAILURE() << warning;
      ++scenes;
    }
    catch (const InputError& error)
    {
      // Scenes of data that are not part of the repository lack their mesh.
      EXPECT_NE(std::string(error.what()).find("mesh"), std::string::npos) << error.what();
    }
  }
  EXPECT_GT(scenes, 5);
  for (const auto& entry : std::filesystem::directory_iterator(kProject + "/config/instruments"))
  {
    std::vector<std::string> warnings;
    if (entry.path().extension() == ".yaml")
      loadInstrument(entry.path().string(), {}, &warnings);
    EXPECT_TRUE(warnings.empty()) << warnings.front();
  }
}

TEST(NumericKeys, EachHasAUnitAndAnInterval)
{
  const std::vector<yaml::NumericKey> keys = numericKeys();
  EXPECT_GT(keys.size(), 150U);
  for (const yaml::NumericKey& key : keys)
  {
    EXPECT_FALSE(key.usual.empty()) << key.path;
    EXPECT_FALSE(key.accepted.empty()) << key.path;
  }
}

TEST(NumericKeys, AreDocumented)
{
  std::ifstream file(kProject + "/docs/KEYS.md");
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_NE(text.str().find(numericKeysTable()), std::string::npos)
      << "write the table of `rosrun endovascular_sim scene_check --keys` into docs/KEYS.md";
}

}  // namespace
}  // namespace endovascular_sim::scene
