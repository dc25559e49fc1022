#include <unistd.h>

#include <filesystem>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <ros/ros.h>

#include "session/session.h"
#include "test/nodes/graph_testing.h"
#include "test/nodes/simulation_client.h"

namespace endovascular_sim
{
namespace
{

constexpr std::uint32_t kInflated = 1503;  ///< step at which the balloon holds the lesion open, within one of the flow
constexpr std::uint32_t kFurther = 400;

std::uint64_t steppedTo(SimulationClient& client, std::uint32_t steps)
{
  const StepSimulation::Response response = client.step(steps);
  EXPECT_TRUE(response.success) << response.message;
  return response.trajectory_hash;
}

TEST(FlowAndBalloon, TheFlowMeasuresTheWallThatContactDetectionSearches)
{
  SimulationClient client;
  session::Session offline(std::string(TEST_DATA_DIR) + "/scenes/good_inflation.yaml", {"flow=adult"});
  ASSERT_TRUE(SimulationClient::waitForServices());
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("flow_and_balloon_" + std::to_string(getpid()) + ".state");

  offline.step(kInflated);
  const std::uint64_t inflated = offline.simulation().trajectoryHash();
  offline.step(kFurther);
  const std::uint64_t later = offline.simulation().trajectoryHash();

  EXPECT_EQ(steppedTo(client, kInflated), inflated);
  const StateFile::Response saved = client.file("simulation/save_state", file);
  ASSERT_TRUE(saved.success) << saved.message;
  EXPECT_EQ(steppedTo(client, kFurther), later);
  const StateFile::Response loaded = client.file("simulation/load_state", file);
  ASSERT_TRUE(loaded.success) << loaded.message;
  EXPECT_EQ(steppedTo(client, kFurther), later) << "after a load";
  EXPECT_TRUE(client.trigger("simulation/reset").success);
  EXPECT_EQ(steppedTo(client, kInflated), inflated) << "after a reset";
  std::filesystem::remove(file);
}

const auto* const kCallbacks = testing::AddGlobalTestEnvironment(new CallbackThread);

}  // namespace
}  // namespace endovascular_sim
