#include "scene/file_search.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace endovascular_sim::scene
{
namespace
{

TEST(FileSearch, ReplacesATildeByTheHomeFolder)
{
  const char* before = std::getenv("HOME");
  const std::string kept = before == nullptr ? "" : before;
  ::setenv("HOME", testing::TempDir().c_str(), 1);
  std::ofstream(std::filesystem::path(testing::TempDir()) / "of_home.obj") << "v 0 0 0\n";
  const std::string found =
      findSceneFile(*yaml::parseTree("mesh: ~/of_home.obj\n", "scene.yaml").find("mesh"), "vessel.mesh", "scene.yaml");
  if (before != nullptr)
    ::setenv("HOME", kept.c_str(), 1);
  EXPECT_TRUE(std::filesystem::equivalent(found, std::filesystem::path(testing::TempDir()) / "of_home.obj"));
}

}  // namespace
}  // namespace endovascular_sim::scene
