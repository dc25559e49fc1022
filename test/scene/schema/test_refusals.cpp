#include <gtest/gtest.h>

#include "scene/model/scene.h"
#include "scene/scene_file.h"
#include "test/common/input_error_of.h"
#include "test/common/temporary_folder.h"
#include "yaml/tree.h"

namespace endovascular_sim::scene
{
namespace
{

const std::string kFolder = TEST_DATA_DIR "/scenes/";

/** Text of a scene of test/data/refused_scenes.yaml. */
std::string textOf(const std::string& scene, const yaml::Node& refusal)
{
  if (const yaml::Node* text = refusal.find("text"))
    return text->text;
  if (const yaml::Node* added = refusal.find("add"))
    return scene + added->text;
  const std::string& replaced = refusal.find("replace")->text;
  return std::string(scene).replace(scene.find(replaced), replaced.size(), refusal.find("by")->text);
}

std::string refusalOf(const std::string& file, const std::vector<std::string>& overrides = {})
{
  return inputErrorOf([&] { loadScene(file, overrides); });
}

bool contains(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

TEST(SceneRefusals, ReportFileKeyLineAndRemedy)
{
  const TemporaryFolder folder;
  const yaml::Node data = yaml::readTree(TEST_DATA_DIR "/refused_scenes.yaml");
  const yaml::Node& refusals = *data.find("refusals");
  EXPECT_GE(refusals.fields.size(), 96U);
  for (const auto& [name, refusal] : refusals.fields)
  {
    const std::string file = folder.write(name + ".yaml", textOf(data.find("scene")->text, refusal));
    const std::string message = refusalOf(file);
    EXPECT_TRUE(contains(message, file + ": " + refusal.find("at")->text + ": ")) << name << "\n" << message;
    EXPECT_TRUE(contains(message, refusal.find("remedy")->text)) << name << "\n" << message;
  }
}

TEST(SceneRefusals, AcceptAValidScene)
{
  EXPECT_EQ(refusalOf(kFolder + "good_bench.yaml"), "");
}

TEST(SceneRefusals, ReportAMissingSceneFile)
{
  EXPECT_TRUE(contains(refusalOf(kFolder + "absent.yaml"), "absent.yaml: no such file"));
  EXPECT_TRUE(contains(refusalOf(kFolder), "is not a file"));
}

TEST(SceneRefusals, ApplyToOverrides)
{
  const std::string file = kFolder + "good_bench.yaml";
  EXPECT_TRUE(contains(refusalOf(file, {"durration=1"}), "durration (--set): unknown key; did you mean \"duration\"?"));
  EXPECT_TRUE(contains(refusalOf(file, {"drive.sped=1"}), "drive.sped (--set): unknown key; did you mean \"speed\"?"));
  EXPECT_TRUE(contains(refusalOf(file, {"solver.time_step=-1"}), "solver.time_step (--set): is -1; must be"));
  EXPECT_TRUE(contains(refusalOf(file, {"instrument.sections.1.radius=1"}), "counted from 0"));
  EXPECT_TRUE(contains(refusalOf(file, {"duration.seconds=1"}), "which has no keys"));
  EXPECT_TRUE(contains(refusalOf(file, {"duration"}), "expected key.path=value"));
  EXPECT_TRUE(contains(refusalOf(file, {"loads.gravity=[0, 0"}), "not valid YAML"));
}

TEST(SceneRefusals, ReportTheFileOfTheInstrument)
{
  const std::string message = refusalOf(std::string(PROJECT_DIR) + "/config/scenes/straight_wire.yaml",
                                        {"instrument=" + kFolder + "wire_without_length.yaml"});
  EXPECT_TRUE(contains(message, "wire_without_length.yaml: instrument.sections.0.length (line 3): missing; give"))
      << message;
}

}  // namespace
}  // namespace endovascular_sim::scene
