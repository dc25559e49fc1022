#include "scene/yaml/yaml_tree.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "common/error.h"
#include "scene/yaml/file_search.h"

namespace endovascular_sim::scene
{
namespace
{

/** Value of an override of `vessel.mesh`. */
SceneNode overridden(const std::string& value)
{
  SceneNode root = parseSceneTree("vessel: {mesh: a.obj}\n", "scene.yaml");
  overrideSceneTree(root, "vessel.mesh=" + value, "scene.yaml");
  const SceneNode* vessel = root.find("vessel");
  const SceneNode* mesh = vessel->find("mesh");
  return mesh == nullptr ? SceneNode() : *mesh;
}

TEST(YamlTree, APlainOverrideNeedsNoQuotes)
{
  for (const std::string path :
       {"my vessels #2/left.obj", "a/vessel: left.obj", "my vessels #2/vessel: left.obj", "a b.obj", "血管/模型.obj"})
    EXPECT_EQ(overridden(path).text, path);
  EXPECT_EQ(overridden("\"my #2/a.obj\"").text, "my #2/a.obj");
  EXPECT_EQ(overridden("'a: b.obj'").text, "a: b.obj");
}

TEST(YamlTree, OtherOverridesAreYaml)
{
  EXPECT_EQ(overridden("null").kind, SceneNode::Kind::kNull);
  EXPECT_EQ(overridden("~").kind, SceneNode::Kind::kNull);
  EXPECT_EQ(overridden("[1, 2]").items.size(), 2U);
  EXPECT_EQ(overridden("{a: 1}").fields.size(), 1U);
  EXPECT_EQ(overridden("-1.5").text, "-1.5");
  EXPECT_THROW(overridden("[1, 2"), InputError);
}

TEST(YamlTree, RefusesAKeyThatIsGivenTwiceAmongMany)
{
  std::string text;
  for (int k = 0; k < 20000; ++k)
    text += "k" + std::to_string(k) + ": 1\n";
  EXPECT_NO_THROW(parseSceneTree(text, "scene.yaml"));
  try
  {
    parseSceneTree(text + "k7: 2\n", "scene.yaml");
    FAIL();
  }
  catch (const InputError& error)
  {
    EXPECT_NE(std::string(error.what()).find("k7 (line 20001): duplicate key, given first in line 8"),
              std::string::npos)
        << error.what();
  }
}

TEST(FileSearch, ReplacesATildeByTheHomeFolder)
{
  const char* before = std::getenv("HOME");
  const std::string kept = before == nullptr ? "" : before;
  ::setenv("HOME", testing::TempDir().c_str(), 1);
  std::ofstream(std::filesystem::path(testing::TempDir()) / "of_home.obj") << "v 0 0 0\n";
  const std::string found = findSceneFile(overridden("~/of_home.obj"), "vessel.mesh", "scene.yaml");
  if (before != nullptr)
    ::setenv("HOME", kept.c_str(), 1);
  EXPECT_TRUE(std::filesystem::equivalent(found, std::filesystem::path(testing::TempDir()) / "of_home.obj"));
}

}  // namespace
}  // namespace endovascular_sim::scene
