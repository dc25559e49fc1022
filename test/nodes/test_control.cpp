#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <crtk_msgs/OperatingState.h>
#include <crtk_msgs/StringStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include "endovascular_sim/DriveApplied.h"
#include "nodes/runtime/scene_parameters.h"
#include "test/nodes/graph_testing.h"
#include "test/nodes/simulation_client.h"
#include "test/nodes/topic_observer.h"

namespace endovascular_sim
{
namespace
{

/** Listener to the steps, the state and the rendered force of the wire. */
class Listener
{
public:
  Listener()
  {
    const std::string wire =
        nodes::names::kInstruments + nodes::sceneFromParameters(ros::NodeHandle()).instruments.front().instrument.name;
    observer_.subscribe<DriveApplied>(nodes::names::kDriveApplied,
                                      [this](const DriveApplied& applied)
                                      {
                                        last_ = applied;
                                        ++count_;
                                      });
    observer_.subscribe<crtk_msgs::OperatingState>(wire + nodes::names::kOperatingState,
                                                   [this](const crtk_msgs::OperatingState& state)
                                                   { operating_ = state.state; });
    observer_.subscribe<crtk_msgs::StringStamped>(
        wire + nodes::names::kStateReason, [this](const crtk_msgs::StringStamped& reason) { text_ = reason.string; });
    observer_.subscribe<sensor_msgs::JointState>(wire + nodes::names::kSetpointJs,
                                                 [this](const sensor_msgs::JointState& joints)
                                                 { force_ = joints.effort.at(0); });
  }

  DriveApplied last() const { return observer_.copy(last_); }
  std::uint64_t count() const { return observer_.copy(count_); }
  std::string state() const { return observer_.copy(operating_); }
  std::string reason() const { return observer_.copy(text_); }
  double force() const { return observer_.copy(force_); }

private:
  DriveApplied last_;
  std::uint64_t count_ = 0;
  std::string operating_, text_;
  double force_ = 0.0;
  TopicObserver observer_;  ///< last, so that it ends before the data that it takes over
};

class Control : public testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    client_ = std::make_unique<SimulationClient>();
    listener_ = std::make_unique<Listener>();
    ASSERT_TRUE(SimulationClient::waitForServices());
    ASSERT_TRUE(waitForSteps(500)) << "the graph steps";
    state_file_ = std::filesystem::temp_directory_path() / ("control_" + std::to_string(getpid()) + ".state");
  }
  static void TearDownTestSuite()
  {
    std::filesystem::remove(state_file_);
    listener_.reset();
    client_.reset();
  }

  /** Waits for further steps. */
  static bool waitForSteps(std::uint64_t count)
  {
    const std::uint64_t begin = listener_->count();
    return waitUntil(60.0, [&] { return listener_->count() >= begin + count; });
  }

  static std::unique_ptr<SimulationClient> client_;
  static std::unique_ptr<Listener> listener_;
  static std::filesystem::path state_file_;
};

std::unique_ptr<SimulationClient> Control::client_;
std::unique_ptr<Listener> Control::listener_;
std::filesystem::path Control::state_file_;

TEST_F(Control, A_AStepCallIsRefusedInRealTime)
{
  const StepSimulation::Response response = client_->step(1);
  EXPECT_FALSE(response.success);
  EXPECT_NE(response.message.find("the pace is real_time"), std::string::npos) << response.message;
  EXPECT_NE(response.message.find("pace:=stepped"), std::string::npos) << response.message;
}

TEST_F(Control, B_APauseHoldsTheWireWithoutForceUntilResume)
{
  ASSERT_TRUE(client_->trigger("simulation/pause").success);
  EXPECT_TRUE(waitUntil(10.0, [] { return listener_->state() == "PAUSED" && listener_->force() == 0.0; }));
  EXPECT_NE(listener_->reason().find("simulation/resume"), std::string::npos) << listener_->reason();
  ros::WallDuration(0.2).sleep();
  const std::uint64_t held = listener_->last().step;
  ros::WallDuration(0.3).sleep();
  EXPECT_EQ(listener_->last().step, held);
  ASSERT_TRUE(client_->trigger("simulation/resume").success);
  EXPECT_TRUE(waitForSteps(200));
  EXPECT_TRUE(waitUntil(10.0, [] { return listener_->state() == "ENABLED" && listener_->reason().empty(); }));
}

TEST_F(Control, C_AStateIsSavedWhileTheWireMoves)
{
  const StateFile::Response saved = client_->file("simulation/save_state", state_file_);
  ASSERT_TRUE(saved.success) << saved.message;
  EXPECT_EQ(saved.message, state_file_);
  EXPECT_TRUE(waitForSteps(300));
}

TEST_F(Control, D_AResetBeginsAtTheFirstStep)
{
  ASSERT_TRUE(client_->trigger("simulation/pause").success);
  const std_srvs::Trigger::Response reset = client_->trigger("simulation/reset");
  ASSERT_TRUE(reset.success) << reset.message;
  EXPECT_NE(reset.message.find("run 2 begins at 0.0 s"), std::string::npos) << reset.message;
  ASSERT_TRUE(client_->trigger("simulation/resume").success);
  EXPECT_TRUE(waitForSteps(300));
  EXPECT_LT(listener_->last().insertion.at(0), 0.03) << "the script begins again";
}

TEST_F(Control, E_ALoadedStateContinuesWhileTheSimulationRuns)
{
  const StateFile::Response loaded = client_->file("simulation/load_state", state_file_);
  ASSERT_TRUE(loaded.success) << loaded.message;
  EXPECT_TRUE(waitForSteps(300));
  std::ofstream(state_file_, std::ios::binary | std::ios::app) << "damage";
  const StateFile::Response damaged = client_->file("simulation/load_state", state_file_);
  EXPECT_FALSE(damaged.success);
  EXPECT_NE(damaged.message.find("is damaged"), std::string::npos) << damaged.message;
  EXPECT_TRUE(waitForSteps(300)) << "a refused state has no effect";
}

// Must run last.
TEST_F(Control, F_EveryRunHasARecordingThatReplays)
{
  const std_srvs::Trigger::Response stopped = client_->trigger("session/stop");
  EXPECT_TRUE(stopped.success);
  const std::filesystem::path folder = std::filesystem::path(stopped.message).parent_path();
  ASSERT_EQ(folder.filename(), "run_3");
  replayedHash(folder.parent_path() / "session.bag");
  replayedHash(folder.parent_path() / "run_2/session.bag");
  replayedHash(folder / "session.bag");
  for (const char* name : {"report.json", "scene.yaml", "trajectory.csv", "metrics.json"})
    EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;

  const std_srvs::Trigger::Response again = client_->trigger("session/stop");
  EXPECT_EQ(again.message, stopped.message) << "a second stop has no effect";
  EXPECT_TRUE(waitForSteps(300)) << "the simulation continues without a recording";
  EXPECT_TRUE(client_->trigger("simulation/reset").success);
  EXPECT_TRUE(waitForSteps(300));
  const std_srvs::Trigger::Response further = client_->trigger("session/stop");
  EXPECT_TRUE(further.success) << "a reset after a stop begins a further recording";
  ASSERT_EQ(std::filesystem::path(further.message).parent_path().filename(), "run_4");
  replayedHash(folder.parent_path() / "run_4/session.bag");
  EXPECT_TRUE(std::filesystem::exists(folder.parent_path() / "run_4/metrics.json")) << "with the vessel";
}

}  // namespace
}  // namespace endovascular_sim
