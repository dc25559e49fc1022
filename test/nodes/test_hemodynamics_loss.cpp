#include <cmath>
#include <filesystem>
#include <set>
#include <string>

#include <crtk_msgs/OperatingState.h>
#include <crtk_msgs/StringStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include "endovascular_sim/SessionProgress.h"
#include "nodes/runtime/ros_names.h"
#include "test/nodes/graph_testing.h"
#include "test/nodes/simulation_client.h"
#include "test/nodes/topic_observer.h"

namespace endovascular_sim
{
namespace
{

TEST(HemodynamicsLoss, PausesWithoutForceUntilTheRestartAndReplays)
{
  std::uint64_t steps = 0;
  double force = 1.0;
  std::string state;
  std::set<std::string> reasons;
  TopicObserver observer;
  observer.subscribe<SessionProgress>(nodes::names::kSessionProgress,
                                      [&steps](const SessionProgress& message) { steps = message.steps; });
  const std::string topics = std::string(nodes::names::kInstruments) + "catheter";
  observer.subscribe<sensor_msgs::JointState>(topics + nodes::names::kSetpointJs,
                                              [&force](const sensor_msgs::JointState& message)
                                              { force = message.effort.at(0); });
  observer.subscribe<crtk_msgs::OperatingState>(topics + nodes::names::kOperatingState,
                                                [&state](const crtk_msgs::OperatingState& message)
                                                { state = message.state; });
  observer.subscribe<crtk_msgs::StringStamped>(topics + nodes::names::kStateReason,
                                               [&reasons](const crtk_msgs::StringStamped& message)
                                               { reasons.insert(message.string); });
  ASSERT_TRUE(waitUntil(60.0, [&] { return observer.copy(steps) > 500; })) << "the graph steps";
  const std::uint64_t before = observer.copy(steps);
  ASSERT_TRUE(killNode("/hemodynamics"));
  EXPECT_TRUE(waitUntil(10.0, [&] { return observer.copy(reasons).count("hemodynamics does not respond") == 1; }));
  EXPECT_TRUE(waitUntil(10.0, [&] { return observer.copy(force) == 0.0; }));
  EXPECT_TRUE(
      waitUntil(30.0, [&] { return observer.copy(state) == "ENABLED" && observer.copy(steps) > before + 500; }));

  SimulationClient client;
  const std_srvs::Trigger::Response stopped = client.trigger("session/stop");
  ASSERT_TRUE(stopped.success) << stopped.message;
  replayedHash(std::filesystem::path(stopped.message).parent_path() / "session.bag");
}

}  // namespace
}  // namespace endovascular_sim
