#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/FluidPressure.h>

#include "endovascular_sim/BloodFlow.h"
#include "endovascular_sim/FlowNetwork.h"
#include "endovascular_sim/HeartPhase.h"
#include "endovascular_sim/HemodynamicControls.h"
#include "endovascular_sim/SetHemodynamics.h"
#include "nodes/session/bag_survey.h"
#include "session/session.h"
#include "test/nodes/graph_testing.h"
#include "test/nodes/simulation_client.h"
#include "test/nodes/topic_observer.h"

namespace endovascular_sim
{
namespace
{

constexpr double kUnchanged = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint32_t kSteps = 2000;     ///< of the first call
constexpr std::uint64_t kFlowSteps = 400;  ///< in them
constexpr double kMean = 12.4e3;           ///< 93 mmHg [Pa]

const std::string kScene = TEST_DATA_DIR "/catheter_in_flow.yaml";

/** Messages of the flow that have arrived. */
struct Messages
{
  std::vector<sensor_msgs::FluidPressure> pressures;
  std::vector<HeartPhase> phases;
  std::vector<BloodFlow> flows;
  std::vector<HemodynamicControls> controls;
  std::optional<FlowNetwork> network;
};

/** Graph with flow of blood, and the same run in this process. */
class Hemodynamics : public testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    client_ = std::make_unique<SimulationClient>();
    reference_ = std::make_unique<session::Session>(kScene);
    observer_ = std::make_unique<TopicObserver>();
    observer_->subscribe<sensor_msgs::FluidPressure>(
        nodes::names::kTipPressure, [](const auto& message) { messages_.pressures.push_back(message); });
    observer_->subscribe<HeartPhase>(nodes::names::kHeartPhase,
                                     [](const auto& message) { messages_.phases.push_back(message); });
    observer_->subscribe<BloodFlow>(nodes::names::kBloodFlow,
                                    [](const auto& message) { messages_.flows.push_back(message); });
    observer_->subscribe<HemodynamicControls>(nodes::names::kHemodynamicControls,
                                              [](const auto& message) { messages_.controls.push_back(message); });
    observer_->subscribe<FlowNetwork>(nodes::names::kFlowNetwork,
                                      [](const auto& message) { messages_.network = message; });
    ASSERT_TRUE(SimulationClient::waitForServices());
    ASSERT_TRUE(waitUntil(20.0, [] { return observer_->copy(messages_.network).has_value(); }));
  }
  static void TearDownTestSuite()
  {
    observer_.reset();
    reference_.reset();
    client_.reset();
  }

  /** Makes steps in the graph and in this process, and compares all of their states. */
  static void step(std::uint32_t steps)
  {
    const StepSimulation::Response response = client_->step(steps);
    ASSERT_TRUE(response.success) << response.message;
    reference_->step(static_cast<int>(steps));
    ASSERT_EQ(response.trajectory_hash, reference_->simulation().trajectoryHash()) << "step " << response.step;
  }

  static SetHemodynamics::Response set(double heart_rate, double mean_pressure, int hyperaemia)
  {
    SetHemodynamics call;
    call.request.heart_rate = heart_rate;
    call.request.mean_pressure = mean_pressure;
    call.request.hyperaemia = static_cast<std::int8_t>(hyperaemia);
    EXPECT_TRUE(ros::service::call(ros::NodeHandle().resolveName(nodes::names::kSetHemodynamics), call));
    return call.response;
  }

  static Messages messages() { return observer_->copy(messages_); }

  static std::unique_ptr<SimulationClient> client_;
  static std::unique_ptr<session::Session> reference_;
  static Messages messages_;
  static std::unique_ptr<TopicObserver> observer_;
};

std::unique_ptr<SimulationClient> Hemodynamics::client_;
std::unique_ptr<session::Session> Hemodynamics::reference_;
Messages Hemodynamics::messages_;
std::unique_ptr<TopicObserver> Hemodynamics::observer_;

// Must run first: the messages are those of the first steps.
TEST_F(Hemodynamics, A_TrajectoryAndPressuresAreThoseOfASession)
{
  step(kSteps);
  ASSERT_TRUE(waitUntil(20.0, [] { return messages().phases.size() >= kFlowSteps; }));
  const Messages all = messages();
  EXPECT_EQ(all.pressures.size(), kFlowSteps) << "one line, at every step of the flow";
  EXPECT_EQ(all.flows.size(), kFlowSteps / 10);
  double sum = 0.0;
  for (const sensor_msgs::FluidPressure& message : all.pressures)
  {
    EXPECT_EQ(message.header.frame_id, "catheter_tip");
    sum += message.fluid_pressure;
  }
  EXPECT_NEAR(sum / static_cast<double>(all.pressures.size()), kMean, 0.1 * kMean);
  EXPECT_EQ(all.pressures[200].header.stamp, ros::Time(1.0)) << "of the step that began it";
  // A result acts a step of the flow after its own.
  EXPECT_EQ(all.pressures[kFlowSteps - 2].fluid_pressure, reference_->observe().pressure(0));
  const flow::FlowField& field = *reference_->observe().blood();
  EXPECT_EQ(all.phases[kFlowSteps - 2].root_pressure, field.pressures.front());
  EXPECT_EQ(all.phases[kFlowSteps - 2].phase, field.phase);
  EXPECT_NEAR(all.phases.back().mean_root_pressure, kMean, 0.1 * kMean);
  ASSERT_TRUE(all.network.has_value());
  EXPECT_EQ(all.network->lines, std::vector<std::string>{"catheter_tip"});
  EXPECT_EQ(all.network->to_node.size(), field.flows.size());
  EXPECT_EQ(all.flows.back().area.size(), field.flows.size());
  EXPECT_EQ(all.flows.back().pressure.size(), field.pressures.size());
}

TEST_F(Hemodynamics, B_RefusedControlsNameTheReasonAndChangeNothing)
{
  const SetHemodynamics::Response fast = set(9.0, kUnchanged, -1);
  EXPECT_FALSE(fast.success);
  EXPECT_NE(fast.message.find("heart_rate is 9 Hz"), std::string::npos) << fast.message;
  const SetHemodynamics::Response high = set(kUnchanged, 1e6, -1);
  EXPECT_FALSE(high.success);
  EXPECT_NE(high.message.find("mean_pressure"), std::string::npos) << high.message;
  EXPECT_FALSE(set(kUnchanged, kUnchanged, 5).success);
  EXPECT_FALSE(set(std::numeric_limits<double>::infinity(), kUnchanged, -1).success);
  step(50);
}

TEST_F(Hemodynamics, C_ControlsActFromTheNextStepOn)
{
  EXPECT_TRUE(set(2.0, kUnchanged, -1).success);
  const SetHemodynamics::Response second = set(kUnchanged, 10e3, 1);
  EXPECT_TRUE(second.success);
  EXPECT_NE(second.message.find("heart rate 2 Hz"), std::string::npos) << second.message;
  const std::uint64_t before = reference_->simulation().steps();
  reference_->setFlowControls({2.0, 10e3, true});
  step(1003);
  ASSERT_TRUE(waitUntil(20.0, [] { return messages().controls.size() == 2; }));
  const HemodynamicControls controls = messages().controls.back();
  EXPECT_EQ(controls.step, before);
  EXPECT_EQ(controls.heart_rate, 2.0);
  EXPECT_EQ(controls.mean_pressure, 10e3);
  EXPECT_TRUE(controls.hyperaemia);
}

TEST_F(Hemodynamics, D_TheSimulationWaitsForARestartedNode)
{
  ASSERT_TRUE(killNode("/hemodynamics"));
  step(400);  // waits, with a pause or without one: the node may be back within a second
  step(400);
}

TEST_F(Hemodynamics, E_AStateSavedWithinAStepOfTheFlowContinues)
{
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("hemodynamics_" + std::to_string(getpid()) + ".state");
  step(2);
  const StateFile::Response saved = client_->file("simulation/save_state", file);
  ASSERT_TRUE(saved.success) << saved.message;
  step(300);
  const std::uint64_t hash = reference_->simulation().trajectoryHash();
  EXPECT_TRUE(set(1.0, kUnchanged, 0).success) << "part of the state";
  const StateFile::Response loaded = client_->file("simulation/load_state", file);
  ASSERT_TRUE(loaded.success) << loaded.message;
  const StepSimulation::Response response = client_->step(300);
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ(response.trajectory_hash, hash);
  std::filesystem::remove(file);
}

// Must run last.
TEST_F(Hemodynamics, F_RecordingsReplayWithTheirControls)
{
  const std_srvs::Trigger::Response stopped = client_->trigger("session/stop");
  ASSERT_TRUE(stopped.success) << stopped.message;
  const std::filesystem::path second = std::filesystem::path(stopped.message).parent_path();
  const std::filesystem::path first = second.parent_path();
  const std::string hash = Hash64::toHex(reference_->simulation().trajectoryHash());
  EXPECT_EQ(replayedHash(first / "session.bag"), hash);
  EXPECT_EQ(replayedHash(second / "session.bag"), hash);
  const nodes::SessionBag recording = nodes::readSessionBag(first / "session.bag");
  EXPECT_EQ(recording.controls.size(), 2U);
  const nodes::BagSurvey survey = nodes::surveyBag(first / "session.bag");
  std::map<std::string, std::uint64_t> counts;
  for (const auto& [topic, content] : survey.topics)
    counts[topic] = content.messages;
  const std::uint64_t flow_steps = (reference_->simulation().steps() + 4) / 5;
  EXPECT_GE(counts["/hemodynamics/tip_pressure"], flow_steps - 5);
  EXPECT_NEAR(static_cast<double>(counts["/hemodynamics/phase"]), 0.25 * static_cast<double>(flow_steps), 5.0);
  EXPECT_NEAR(static_cast<double>(counts["/hemodynamics/flow"]), 0.05 * static_cast<double>(flow_steps), 5.0);
  EXPECT_EQ(counts.count("/hemodynamics/request"), 0U);
}

const auto* const kCallbacks = testing::AddGlobalTestEnvironment(new CallbackThread);

}  // namespace
}  // namespace endovascular_sim
