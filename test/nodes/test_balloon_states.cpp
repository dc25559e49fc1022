#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <nlohmann/json.hpp>

#include "common/hash.h"
#include "session/session.h"
#include "test/nodes/graph_testing.h"
#include "test/nodes/simulation_client.h"

namespace endovascular_sim
{
namespace
{

constexpr int kInflated = 1500;  ///< step at which the balloon holds the lesion open
constexpr int kEnd = 2500;       ///< step at which it is empty again

std::string scene()
{
  return std::string(TEST_DATA_DIR) + "/scenes/good_inflation.yaml";
}

std::string contentOf(const std::filesystem::path& path)
{
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string hashOf(const session::Session& session)
{
  return Hash64::toHex(session.simulation().trajectoryHash());
}

/** Graph with a balloon, in which clients save, load and reset while the wall is deformed. */
class BalloonStates : public testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    client_ = std::make_unique<SimulationClient>();
    offline_ = std::make_unique<session::Session>(scene());
    folder_ = std::filesystem::temp_directory_path() / ("balloon_states_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    ASSERT_TRUE(SimulationClient::waitForServices());
  }
  static void TearDownTestSuite()
  {
    std::filesystem::remove_all(folder_);
    offline_.reset();
    client_.reset();
  }

  static std::string path(const std::string& name) { return (folder_ / name).string(); }

  static void step(int steps)
  {
    const StepSimulation::Response response = client_->step(static_cast<std::uint32_t>(steps));
    ASSERT_TRUE(response.success) << response.message;
  }

  static void load(const std::string& name)
  {
    const StateFile::Response loaded = client_->file("simulation/load_state", path(name));
    ASSERT_TRUE(loaded.success) << loaded.message;
  }

  static std::unique_ptr<SimulationClient> client_;
  static std::unique_ptr<session::Session> offline_;
  static std::filesystem::path folder_;
};

std::unique_ptr<SimulationClient> BalloonStates::client_;
std::unique_ptr<session::Session> BalloonStates::offline_;
std::filesystem::path BalloonStates::folder_;

TEST_F(BalloonStates, A_AStateOfTheGraphContinuesOffline)
{
  step(kInflated);
  const StateFile::Response saved = client_->file("simulation/save_state", path("graph.state"));
  ASSERT_TRUE(saved.success) << saved.message;
  step(kEnd - kInflated);

  offline_->step(kInflated);
  std::ofstream(path("offline.state"), std::ios::binary) << offline_->save();
  offline_->step(kEnd - kInflated);
  session::Session resumed(scene());
  resumed.load(contentOf(path("graph.state")));
  resumed.step(kEnd - kInflated);
  EXPECT_EQ(hashOf(resumed), hashOf(*offline_));
}

TEST_F(BalloonStates, B_TheGraphContinuesFromAStateOfItsOwn)
{
  load("graph.state");
  step(kEnd - kInflated);
}

TEST_F(BalloonStates, C_AResetReturnsToTheInitialWall)
{
  const std_srvs::Trigger::Response reset = client_->trigger("simulation/reset");
  ASSERT_TRUE(reset.success) << reset.message;
  step(kEnd);
}

TEST_F(BalloonStates, D_TheGraphContinuesFromAStateOfTheOfflineSimulationAndARefusedOneLeavesTheWall)
{
  load("offline.state");
  // It is refused for its seed, which stands behind the wall in the file.
  session::Session varied(scene());
  varied.reset(3);
  varied.step(400);
  std::ofstream(path("varied.state"), std::ios::binary) << varied.save();
  const StateFile::Response refused = client_->file("simulation/load_state", path("varied.state"));
  EXPECT_FALSE(refused.success);
  EXPECT_NE(refused.message.find("has a varied start"), std::string::npos) << refused.message;
  step(kEnd - kInflated);
}

// Must run last.
TEST_F(BalloonStates, E_AllRunsReplayAndEqualTheOfflineSimulation)
{
  const std_srvs::Trigger::Response stopped = client_->trigger("session/stop");
  EXPECT_TRUE(stopped.success) << stopped.message;
  const std::filesystem::path last = std::filesystem::path(stopped.message).parent_path();
  ASSERT_EQ(last.filename(), "run_4");
  const std::filesystem::path folder = last.parent_path();
  const nlohmann::json first = nlohmann::json::parse(std::ifstream(folder / "metrics.json"));
  for (const std::string run : {".", "run_2", "run_3", "run_4"})
  {
    EXPECT_EQ(replayedHash((folder / run / "session.bag").string()), hashOf(*offline_)) << run;
    const nlohmann::json metrics = nlohmann::json::parse(std::ifstream(folder / run / "metrics.json"));
    ASSERT_EQ(metrics.at("lesions").size(), 1U) << run;
    EXPECT_EQ(metrics.at("lesions"), first.at("lesions")) << run;
  }
}

const auto* const kCallbacks = testing::AddGlobalTestEnvironment(new CallbackThread);

}  // namespace
}  // namespace endovascular_sim
