#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/error.h"
#include "common/releases.h"
#include "nodes/session/recorded_simulation.h"
#include "nodes/session/session_bag.h"
#include "session/session.h"

namespace endovascular_sim::nodes
{
namespace
{

std::string bytesOf(const std::string& file)
{
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/** Expects that a file of a release is read, or refused by the name of a release that reads it. */
void expectReadOrNamed(const std::string& file, const std::function<void()>& read)
{
  ASSERT_TRUE(std::filesystem::exists(file)) << file;
  try
  {
    read();
  }
  catch (const InputError& error)
  {
    bool is_named = false;
    for (const Release& release : releases())
      is_named = is_named || std::string(error.what()).find("with endovascular_sim " + std::string(release.version)) !=
                                 std::string::npos;
    EXPECT_TRUE(is_named) << error.what();
  }
}

TEST(SamplesOfReleases, AreReadOrRefusedByTheNameOfARelease)
{
  for (const Release& release : releases())
  {
    const std::string folder = std::string(TEST_DATA_DIR "/releases/") + release.version;
    const std::string scene = folder + "/scene.yaml", state = folder + "/session.state", bag = folder + "/session.bag";
    expectReadOrNamed(scene, [&] { session::World::open(scene); });
    expectReadOrNamed(state, [&] { session::Session(session::World::open(scene)).load(bytesOf(state), state); });
    expectReadOrNamed(bag, [&] { RecordedSimulation(readSessionBag(bag), bag); });
  }
}

TEST(SamplesOfReleases, OfThisVersionAreRead)
{
  const std::string folder = std::string(TEST_DATA_DIR "/releases/") + releases().back().version;
  session::Session session(session::World::open(folder + "/scene.yaml"));
  session.load(bytesOf(folder + "/session.state"), folder);
  EXPECT_EQ(session.simulation().steps(), 100U);
  const SessionBag bag = readSessionBag(folder + "/session.bag");
  RecordedSimulation recorded(bag, folder);
  const ReplayOutcome outcome = replay(bag, recorded, false);
  EXPECT_EQ(outcome.different, 0U);
  EXPECT_EQ(outcome.compared, 200U);
}

}  // namespace
}  // namespace endovascular_sim::nodes
