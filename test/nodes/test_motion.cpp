#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ros/ros.h>

#include "endovascular_sim/MotionControls.h"
#include "endovascular_sim/MotionState.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/SetMotion.h"
#include "nodes/conversions/motion_conversions.h"
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
constexpr std::uint32_t kSteps = 800;  ///< of the first call
constexpr std::size_t kStates = 50;    ///< for display in them

const std::string kScene = TEST_DATA_DIR "/catheter_in_motion.yaml";

/** Messages that have arrived. */
struct Messages
{
  std::vector<MotionState> states;
  std::vector<MotionControls> controls;
  std::vector<RodStateVisual> rods;
};

/** Graph with a moving patient, and the same run in this process. */
class Motion : public testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    client_ = std::make_unique<SimulationClient>();
    reference_ = std::make_unique<session::Session>(kScene);
    observer_ = std::make_unique<TopicObserver>();
    observer_->subscribe<MotionState>(nodes::names::kMotionState,
                                      [](const auto& message) { messages_.states.push_back(message); });
    observer_->subscribe<MotionControls>(nodes::names::kMotionControls,
                                         [](const auto& message) { messages_.controls.push_back(message); });
    observer_->subscribe<RodStateVisual>(nodes::names::kRodStateVisual,
                                         [](const auto& message) { messages_.rods.push_back(message); });
    ASSERT_TRUE(SimulationClient::waitForServices());
    ASSERT_TRUE(waitUntil(20.0, [] { return !messages().controls.empty(); }));
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

  static SetMotion::Response set(double heart_rate, double breathing_rate, int breath_hold)
  {
    SetMotion call;
    call.request.heart_rate = heart_rate;
    call.request.breathing_rate = breathing_rate;
    call.request.breath_hold = static_cast<std::int8_t>(breath_hold);
    EXPECT_TRUE(ros::service::call(ros::NodeHandle().resolveName(nodes::names::kSetMotion), call));
    return call.response;
  }

  static Messages messages() { return observer_->copy(messages_); }

  static std::unique_ptr<SimulationClient> client_;
  static std::unique_ptr<session::Session> reference_;
  static Messages messages_;
  static std::unique_ptr<TopicObserver> observer_;
};

std::unique_ptr<SimulationClient> Motion::client_;
std::unique_ptr<session::Session> Motion::reference_;
Messages Motion::messages_;
std::unique_ptr<TopicObserver> Motion::observer_;

// Must run first: the messages are those of the first steps.
TEST_F(Motion, A_EveryStateForDisplayHasTheMotionOfItsStep)
{
  EXPECT_EQ(messages().controls.front().heart_rate, 1.25);
  EXPECT_EQ(messages().controls.front().step, 0U);
  step(kSteps);
  ASSERT_TRUE(waitUntil(20.0, [] { return messages().states.size() >= kStates && messages().rods.size() >= kStates; }));
  const Messages all = messages();
  ASSERT_EQ(all.states.size(), kStates);
  ASSERT_EQ(all.rods.size(), kStates);
  session::Session session(kScene);
  for (std::size_t k = 0; k < kStates; ++k)
  {
    EXPECT_EQ(all.states[k].step, all.rods[k].step);
    EXPECT_EQ(all.states[k].header.stamp, all.rods[k].header.stamp);
    EXPECT_EQ(all.states[k].time, all.rods[k].time);
    session.step(static_cast<int>(all.states[k].step + 1 - session.simulation().steps()));
    const motion::MovingPatient& patient = *session.observe().motion();
    ASSERT_EQ(all.states[k].heart_phase, patient.heart().phase()) << k;
    const Eigen::Vector3d point = patient.map().frame().base;
    ASSERT_EQ(nodes::fromMessage(all.states[k]).position(point), patient.map().position(point)) << k;
    ASSERT_EQ(nodes::fromMessage(all.states[k]).velocity(point), patient.map().velocity(point)) << k;
  }
}

TEST_F(Motion, B_RefusedControlsNameTheReasonAndChangeNothing)
{
  const SetMotion::Response fast = set(400.0 / 60.0, kUnchanged, -1);
  EXPECT_FALSE(fast.success);
  EXPECT_NE(fast.message.find("heart_rate is 6.66667 Hz"), std::string::npos) << fast.message;
  EXPECT_FALSE(set(0.0, kUnchanged, -1).success);
  EXPECT_NE(set(kUnchanged, 0.0, -1).message.find("breathing_rate is 0 Hz"), std::string::npos);
  EXPECT_FALSE(set(kUnchanged, kUnchanged, 5).success);
  EXPECT_FALSE(set(kUnchanged, std::numeric_limits<double>::infinity(), -1).success);
  step(16);
}

TEST_F(Motion, C_ControlsActFromTheNextStepOn)
{
  EXPECT_TRUE(set(2.0, kUnchanged, -1).success);
  const SetMotion::Response second = set(kUnchanged, 0.5, 1);
  EXPECT_TRUE(second.success);
  EXPECT_NE(second.message.find("heart rate 2 Hz"), std::string::npos) << second.message;
  const std::uint64_t before = reference_->simulation().steps();
  reference_->setMotionControls({2.0, 0.5, true});
  step(1008);
  ASSERT_TRUE(waitUntil(20.0, [] { return messages().controls.size() == 2; }));
  const MotionControls controls = messages().controls.back();
  EXPECT_EQ(controls.step, before);
  EXPECT_EQ(controls.heart_rate, 2.0);
  EXPECT_EQ(controls.breathing_rate, 0.5);
  EXPECT_TRUE(controls.breath_held);
  ASSERT_TRUE(waitUntil(20.0, [] { return messages().states.back().step + 1 == reference_->simulation().steps(); }));
  EXPECT_EQ(messages().states.back().heart_phase, reference_->observe().motion()->heart().phase());
}

TEST_F(Motion, D_ASavedStateHoldsPhasesAndControls)
{
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("motion_" + std::to_string(getpid()) + ".state");
  const StateFile::Response saved = client_->file("simulation/save_state", file);
  ASSERT_TRUE(saved.success) << saved.message;
  EXPECT_TRUE(set(1.0, 0.2, 0).success);
  ASSERT_TRUE(client_->step(304).success);
  const StateFile::Response loaded = client_->file("simulation/load_state", file);
  ASSERT_TRUE(loaded.success) << loaded.message;
  step(304);
  ASSERT_TRUE(waitUntil(20.0, [] { return messages().states.back().step + 1 == reference_->simulation().steps(); }));
  EXPECT_EQ(messages().states.back().heart_phase, reference_->observe().motion()->heart().phase());
  EXPECT_EQ(messages().controls.back().heart_rate, 2.0);
  std::filesystem::remove(file);
}

// Must run last.
TEST_F(Motion, E_RecordingsReplayWithTheirControls)
{
  const std_srvs::Trigger::Response stopped = client_->trigger("session/stop");
  ASSERT_TRUE(stopped.success) << stopped.message;
  const std::filesystem::path second = std::filesystem::path(stopped.message).parent_path();
  const std::filesystem::path first = second.parent_path();
  EXPECT_EQ(replayedHash(second / "session.bag"), Hash64::toHex(reference_->simulation().trajectoryHash()));
  const nodes::SessionBag recording = nodes::readSessionBag(first / "session.bag");
  ASSERT_EQ(recording.motion_controls.size(), 3U);
  EXPECT_EQ(recording.motion_controls.at(kSteps + 16), (motion::MotionControls{2.0, 0.5, true}));
  const nodes::BagSurvey survey = nodes::surveyBag(first / "session.bag");
  std::map<std::string, std::uint64_t> counts;
  for (const auto& [topic, content] : survey.topics)
    counts[topic] = content.messages;
  EXPECT_GT(counts["/motion/state"], 50U);
  EXPECT_EQ(counts["/motion/state"], counts["/rod/state_visual"]);
}

const auto* const kCallbacks = testing::AddGlobalTestEnvironment(new CallbackThread);

}  // namespace
}  // namespace endovascular_sim
