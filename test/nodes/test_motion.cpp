#include <unistd.h>

#include <algorithm>
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
constexpr std::uint32_t kStepsPerState = 16;  ///< between two states for display
constexpr int kStates = 50;                   ///< for display, which are compared

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
  static std::uint64_t changed_;  ///< step of the first change of controls
  static Messages messages_;
  static std::unique_ptr<TopicObserver> observer_;
};

std::unique_ptr<SimulationClient> Motion::client_;
std::unique_ptr<session::Session> Motion::reference_;
std::uint64_t Motion::changed_ = 0;
Messages Motion::messages_;
std::unique_ptr<TopicObserver> Motion::observer_;

// Must run first: the controls are those of the beginning.
TEST_F(Motion, A_EveryStateForDisplayHasTheMotionOfItsStep)
{
  EXPECT_EQ(messages().controls.front().heart_rate, 1.25);
  EXPECT_EQ(messages().controls.front().step, 0U);
  // A message that was published before its subscription is lost.
  for (int k = 0; k < 100 && (messages().states.empty() || messages().rods.empty()); ++k)
  {
    step(kStepsPerState);
    waitUntil(0.2, [] { return !messages().states.empty() && !messages().rods.empty(); });
  }
  const std::uint64_t first = reference_->simulation().steps();
  step(kStates * kStepsPerState);
  const auto whole = [first](const auto& all)
  { return std::count_if(all.begin(), all.end(), [first](const auto& one) { return one.step >= first; }) >= kStates; };
  ASSERT_TRUE(waitUntil(20.0, [&] { return whole(messages().states) && whole(messages().rods); }));
  const Messages all = messages();
  session::Session session(kScene);
  auto rod = all.rods.begin();
  int compared = 0;
  for (const MotionState& state : all.states)
  {
    while (rod != all.rods.end() && rod->step < state.step)
      ++rod;
    if (rod == all.rods.end() || rod->step != state.step)
    {
      ASSERT_LT(state.step, first) << "has no state of the rod";
      continue;
    }
    EXPECT_EQ(state.header.stamp, rod->header.stamp);
    EXPECT_EQ(state.time, rod->time);
    session.step(static_cast<int>(state.step + 1 - session.simulation().steps()));
    const motion::MovingPatient& patient = *session.observe().motion();
    ASSERT_EQ(state.heart_phase, patient.heart().phase()) << state.step;
    const Eigen::Vector3d point = patient.map().frame().base;
    ASSERT_EQ(nodes::fromMessage(state).position(point), patient.map().position(point)) << state.step;
    ASSERT_EQ(nodes::fromMessage(state).velocity(point), patient.map().velocity(point)) << state.step;
    ++compared;
  }
  EXPECT_GE(compared, kStates);
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
  changed_ = reference_->simulation().steps();
  reference_->setMotionControls({2.0, 0.5, true});
  step(1008);
  ASSERT_TRUE(waitUntil(20.0, [] { return messages().controls.size() == 2; }));
  const MotionControls controls = messages().controls.back();
  EXPECT_EQ(controls.step, changed_);
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
  EXPECT_EQ(recording.motion_controls.at(changed_), (motion::MotionControls{2.0, 0.5, true}));
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
