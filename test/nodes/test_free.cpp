#include <atomic>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <ros/ros.h>

#include "endovascular_sim/SessionProgress.h"
#include "test/nodes/graph_testing.h"
#include "test/nodes/simulation_client.h"

namespace endovascular_sim
{
namespace
{

constexpr double kSeconds = 10.5;
constexpr std::uint64_t kSteps = 10500;

TEST(Free, TheTrajectoryIsThatOfSimulateAndTheRecordingIsComplete)
{
  const std::string data = TEST_DATA_DIR;
  SimulationClient client;
  std::atomic<std::uint64_t> recorded{0};
  ros::NodeHandle node;
  const ros::Subscriber subscriber = node.subscribe<SessionProgress>(
      nodes::names::kSessionProgress, 10,
      [&recorded](const SessionProgressConstPtr& progress) { recorded = progress->steps; });
  ASSERT_TRUE(waitUntil(90.0, [&recorded] { return recorded > 500; })) << "the graph steps";
  EXPECT_TRUE(killNode("/contact"));  // its restart is waited for
  ASSERT_TRUE(waitUntil(120.0, [&recorded] { return recorded == kSteps; })) << recorded;
  const std_srvs::Trigger::Response stopped = client.trigger("session/stop");
  EXPECT_TRUE(stopped.success);
  const std::filesystem::path folder = std::filesystem::path(stopped.message).parent_path();
  EXPECT_EQ(replayedHash(folder / "session.bag"),
            hashOfSimulate(data + "/wire_of_a_robot.yaml", data + "/commands_of_a_robot.csv", kSeconds));
}

const auto* const kCallbacks = testing::AddGlobalTestEnvironment(new CallbackThread);

}  // namespace
}  // namespace endovascular_sim
