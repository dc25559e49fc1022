#include <iterator>
#include <random>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/error.h"
#include "scene/scene_file.h"
#include "session/session.h"

// Scenes with wrong numbers: they run with finite positions, or are rejected by an InputError.

namespace endovascular_sim::simulation
{
namespace
{

constexpr int kScenes = 120;

/** Paths of the keys of a scene that are a number in a section, e.g. "drive.speed". */
std::vector<std::string> numberPaths(const std::string& resolved_yaml)
{
  const std::regex section_pattern("([a-z_]+):.*");
  const std::regex number_pattern("  ([a-z_]+): [-+]?[0-9.].*");
  std::vector<std::string> paths;
  std::string section;
  std::istringstream lines(resolved_yaml);
  for (std::string line; std::getline(lines, line);)
  {
    std::smatch match;
    if (std::regex_match(line, match, section_pattern))
      section = match[1];
    else if (std::regex_match(line, match, number_pattern))
      paths.push_back(section + "." + match[1].str());
  }
  return paths;
}

TEST(DamagedScene, RunsWithFinitePositionsOrIsRejected)
{
  static const char* const kFiles[] = {"tube", "straight_wire", "cantilever", "catheter"};
  static const char* const kNumbers[] = {"-1", "0", "1e-9", "1e9", "1e300", "1e-300", ".inf", "3", "1000", "0.5"};
  std::mt19937 random(1);
  int ran = 0;
  for (int k = 0; k < kScenes; ++k)
  {
    const std::string file =
        std::string(PROJECT_DIR "/config/scenes/") + kFiles[static_cast<std::size_t>(k) % std::size(kFiles)] + ".yaml";
    const std::vector<std::string> paths = numberPaths(scene::loadScene(file).resolved_yaml);
    ASSERT_FALSE(paths.empty());
    const std::string change = paths[random() % paths.size()] + "=" + kNumbers[random() % std::size(kNumbers)];
    SCOPED_TRACE(file + " " + change);
    try
    {
      session::Session session(file, {change});
      for (int step = 0; step < 5 && !session.isOver(); ++step)
        session.step();
      ++ran;
      for (const Eigen::Vector3d& node : session.simulation().state().position)
        ASSERT_TRUE(node.allFinite());
    }
    catch (const InputError&)
    {
      continue;
    }
  }
  EXPECT_GT(ran, 0);
}

}  // namespace
}  // namespace endovascular_sim::simulation
