#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/JointState.h>

#include "drive/command_file.h"
#include "session/session.h"
#include "test/nodes/graph_testing.h"
#include "test/nodes/simulation_client.h"

namespace endovascular_sim
{
namespace
{

constexpr double kSeconds = 10.5;  ///< simulated time of all commands [s]
constexpr std::uint32_t kSteps = 10500;
constexpr double kShort = 3.5;  ///< simulated time of the first commands [s]
constexpr std::uint32_t kShortSteps = 3500;
constexpr std::uint32_t kMostAhead = 5000;  ///< steps that may lie before the recorder (step_obstacles.cpp)
constexpr std::uint32_t kLongSteps = 7000;

class Stepped : public testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    client_ = std::make_unique<SimulationClient>();
    ASSERT_TRUE(SimulationClient::waitForServices());
    diagnostics_ = ros::NodeHandle().subscribe("/diagnostics", 100, &Stepped::receiveDiagnostics);
    folder_ = std::filesystem::temp_directory_path() / ("stepped_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  static void TearDownTestSuite()
  {
    std::filesystem::remove_all(folder_);
    diagnostics_.shutdown();
    client_.reset();
  }

  static std::string commands() { return std::string(TEST_DATA_DIR) + "/commands_of_a_robot.csv"; }
  static std::string scene() { return std::string(TEST_DATA_DIR) + "/wire_of_a_robot.yaml"; }

  /** Gives the commands of the file from a step on, by calls of a size. @return response of the last call */
  static StepSimulation::Response run(std::uint32_t from, std::uint32_t to, std::uint32_t size)
  {
    StepSimulation::Response last;
    const std::vector<drive::TimedCommand> rows = drive::readCommandFile(commands());
    for (std::uint32_t step = from; step < to; step += size)
    {
      std::vector<InstrumentCommand> due;
      for (const drive::TimedCommand& row : rows)
        if (static_cast<std::uint32_t>(std::lround(1e3 * row.time)) == step)
          due.push_back(commandOf(row));
      last = client_->step(size, due);
      EXPECT_TRUE(last.success) << last.message;
      if (!last.success)
        break;
    }
    return last;
  }

  static void receiveDiagnostics(const diagnostic_msgs::DiagnosticArrayConstPtr& message)
  {
    for (const diagnostic_msgs::DiagnosticStatus& status : message->status)
    {
      std::uint64_t sum = 0;
      bool has_counts = false;
      for (const diagnostic_msgs::KeyValue& value : status.values)
        if (value.key.find("instruments/wire: rejected, ") != std::string::npos)
        {
          sum += std::stoull(value.value);
          has_counts = true;
        }
      if (has_counts)
        rejections_ = sum;
    }
  }

  static std::unique_ptr<SimulationClient> client_;
  static std::filesystem::path folder_;
  static ros::Subscriber diagnostics_;
  static std::atomic<std::uint64_t> rejections_;  ///< of commands to the wire, by the diagnostics
  static std::string waited_for_recorder_;        ///< hash of the trajectory that waited for the recorder
};

std::unique_ptr<SimulationClient> Stepped::client_;
std::filesystem::path Stepped::folder_;
ros::Subscriber Stepped::diagnostics_;
std::atomic<std::uint64_t> Stepped::rejections_{0};
std::string Stepped::waited_for_recorder_;

InstrumentCommand command(const std::string& instrument, const std::string& word, std::vector<double> position)
{
  return commandOf({0.0, instrument, word, std::move(position), 0});
}

// Must run first.
TEST_F(Stepped, A_RefusedCallsNameTheReasonAndChangeNothing)
{
  const auto refusal = [](std::uint32_t steps, const std::vector<InstrumentCommand>& commands)
  {
    const StepSimulation::Response response = client_->step(steps, commands);
    EXPECT_FALSE(response.success);
    EXPECT_EQ(response.step, 0U);
    EXPECT_EQ(response.instruments.at(0).measured.position.at(0), 0.02);
    return response.message;
  };
  const std::string needle = "the scene has no instrument 'needle'; it has wire";
  EXPECT_NE(refusal(1, {command("needle", "servo_jp", {0.02})}).find(needle), std::string::npos);
  EXPECT_NE(refusal(1, {command("wire", "servo_cp", {0.02})}).find("unknown command 'servo_cp'"), std::string::npos);
  EXPECT_NE(refusal(1, {command("wire", "servo_jp", {0.5})}).find("beyond drive.limits"), std::string::npos);
  EXPECT_NE(refusal(1, {command("wire", "servo_jp", {std::nan("")})}).find("not finite"), std::string::npos);
  EXPECT_NE(refusal(1, {command("wire", "servo_jp", {})}).find("joints missing"), std::string::npos);
  EXPECT_NE(refusal(1000000, {}).find("must be at most 100000"), std::string::npos);
  // The first command alone would be accepted.
  const std::string second = refusal(1, {command("wire", "move_jp", {0.1}), command("wire", "servo_jp", {0.5})});
  EXPECT_NE(second.find("commands[1]: wire: servo_jp of simulation/step"), std::string::npos) << second;
  EXPECT_FALSE(client_->step(0).instruments.at(0).is_busy);
  EXPECT_TRUE(waitUntil(10.0, [] { return rejections_ == 4U; })) << rejections_ << " rejected commands to the wire";
  ASSERT_TRUE(client_->trigger("simulation/pause").success);
  EXPECT_NE(refusal(1, {}).find("simulation/resume"), std::string::npos);
  ASSERT_TRUE(client_->trigger("simulation/resume").success);
}

TEST_F(Stepped, B_TheTrajectoryIsThatOfSimulateForAnySizeOfCalls)
{
  const StepSimulation::Response last = run(0, kSteps, 1);
  EXPECT_EQ(last.step, kSteps);
  EXPECT_NEAR(last.time, kSeconds, 1e-9);
  EXPECT_EQ(Hash64::toHex(last.trajectory_hash), hashOfSimulate(scene(), commands(), kSeconds)) << "single steps";
  EXPECT_EQ(last.instruments.at(0).name, "wire");
  EXPECT_EQ(last.instruments.at(0).state, "DISABLED");
  EXPECT_NE(last.instruments.at(0).branch, "");
  const std::string expected = hashOfSimulate(scene(), commands(), kShort);
  for (const std::uint32_t size : {7U, 100U})
  {
    ASSERT_TRUE(client_->trigger("simulation/reset").success);
    EXPECT_EQ(client_->step(0).step, 0U);
    EXPECT_EQ(Hash64::toHex(run(0, kShortSteps, size).trajectory_hash), expected) << size << " steps per call";
  }
}

TEST_F(Stepped, C_ALoadedStateContinuesBitForBit)
{
  const std::string file = folder_ / "middle.state";
  ASSERT_TRUE(client_->trigger("simulation/reset").success);
  run(0, 2800, 100);  // in the middle of a velocity's ramp to zero, and of the claim of its driver
  const StateFile::Response saved = client_->file("simulation/save_state", file);
  ASSERT_TRUE(saved.success) << saved.message;
  const std::uint64_t expected = run(2800, 4900, 100).trajectory_hash;
  const StateFile::Response loaded = client_->file("simulation/load_state", file);
  ASSERT_TRUE(loaded.success) << loaded.message;
  EXPECT_EQ(client_->step(0).step, 2800U);
  EXPECT_EQ(run(2800, 4900, 7).trajectory_hash, expected);
}

TEST_F(Stepped, D_AWrongStateFileIsRefusedByName)
{
  const std::uint64_t before = client_->step(0).trajectory_hash;
  const auto refusal = [](const std::string& file)
  {
    const StateFile::Response response = client_->file("simulation/load_state", file);
    EXPECT_FALSE(response.success);
    EXPECT_TRUE(file.empty() || response.message.find(file) != std::string::npos) << response.message;
    return response.message;
  };
  const std::string other = folder_ / "other.state";
  session::Session session(std::string(TEST_DATA_DIR) + "/wire_of_a_robot.yaml", {"drive.force_limit=0.4"});
  std::ofstream stream(other, std::ios::binary);
  session.simulation().save(stream, session.world().meshHash());
  stream.close();
  EXPECT_NE(refusal(other).find("was saved in another scene"), std::string::npos);
  EXPECT_NE(refusal(folder_ / "none.state").find("No such file"), std::string::npos);
  EXPECT_NE(refusal(folder_).find("is no file"), std::string::npos);
  EXPECT_NE(refusal("/dev/zero").find("is no file"), std::string::npos);
  EXPECT_NE(refusal(scene()).find("is not a saved state"), std::string::npos);
  EXPECT_NE(refusal("").find("file"), std::string::npos);
  EXPECT_FALSE(client_->file("simulation/save_state", folder_ / "none" / "x.state").success);
  EXPECT_EQ(client_->step(0).trajectory_hash, before);
  EXPECT_TRUE(client_->step(10).success);
}

TEST_F(Stepped, E_SimulatedTimeStandsStillBetweenCalls)
{
  std::atomic<double> clock{-1.0};
  ros::NodeHandle node;
  const ros::Subscriber subscriber = node.subscribe<rosgraph_msgs::Clock>(
      "/clock", 100, [&clock](const rosgraph_msgs::ClockConstPtr& now) { clock = now->clock.toSec(); });
  ASSERT_TRUE(waitUntil(10.0, [&subscriber] { return subscriber.getNumPublishers() > 0; }));
  const StepSimulation::Response response = client_->step(3);
  EXPECT_TRUE(waitUntil(10.0, [&] { return std::abs(clock - response.time) < 1e-9; })) << clock;
  EXPECT_TRUE(waitUntil(10.0, [&] { return std::abs(ros::Time::now().toSec() - response.time) < 1e-9; }));
  EXPECT_NEAR(response.instruments.at(0).measured.header.stamp.toSec(), response.time, 1e-9)
      << "a stamp of 0 is invalid data";
}

TEST_F(Stepped, F_ADeadClientLeavesNoForceAndTheNextOneContinues)
{
  std::atomic<double> force{1.0};
  ros::NodeHandle node;
  const ros::Subscriber subscriber = node.subscribe<sensor_msgs::JointState>(
      "instruments/wire/setpoint_js", 1,
      [&force](const sensor_msgs::JointStateConstPtr& joints) { force = joints->effort.at(0); });
  ASSERT_TRUE(client_->step(100, {command("wire", "resume", {})}).success);
  const std::uint64_t before = client_->step(0).step;
  const pid_t other = fork();
  if (other == 0)
  {
    execlp("rosservice", "rosservice", "call", "/simulation/step",
           "{steps: 3000, commands: [{instrument: wire, command: move_jp, joints: {position: [0.2]}}]}", nullptr);
    _exit(1);
  }
  // The call is under way when the clock moves.
  EXPECT_TRUE(
      waitUntil(60.0, [before] { return ros::Time::now().toSec() > 1e-3 * static_cast<double>(before) + 0.1; }));
  kill(other, SIGKILL);
  waitpid(other, nullptr, 0);
  const StepSimulation::Response response = client_->step(1);
  EXPECT_TRUE(response.success) << response.message;
  EXPECT_EQ(response.step, before + 3001U) << "the call of the dead client was complete";
  EXPECT_TRUE(waitUntil(10.0, [&force] { return force == 0.0; }));
  EXPECT_TRUE(client_->step(10, {command("wire", "servo_jr", {-1e-4})}).success);
}

TEST_F(Stepped, G_AMissingContactNodeIsWaitedFor)
{
  ASSERT_TRUE(client_->trigger("simulation/reset").success);
  ASSERT_TRUE(killNode("/contact"));
  EXPECT_EQ(Hash64::toHex(run(0, kShortSteps, 100).trajectory_hash), hashOfSimulate(scene(), commands(), kShort));
}

TEST_F(Stepped, H_StepsWaitForTheRecorderAndNoneIsLost)
{
  ASSERT_TRUE(client_->trigger("simulation/reset").success);
  const pid_t session = processOf("/session");
  ASSERT_GT(session, 0);
  ASSERT_EQ(kill(session, SIGSTOP), 0);
  const StepSimulation::Response behind = client_->step(kLongSteps);
  ASSERT_EQ(kill(session, SIGCONT), 0);
  EXPECT_FALSE(behind.success);
  EXPECT_NE(behind.message.find("the recorder lags behind"), std::string::npos) << behind.message;
  EXPECT_LE(behind.step, kMostAhead);
  const StepSimulation::Response rest = client_->step(kLongSteps - static_cast<std::uint32_t>(behind.step));
  EXPECT_TRUE(rest.success) << rest.message;
  EXPECT_EQ(rest.step, kLongSteps);
  waited_for_recorder_ = Hash64::toHex(rest.trajectory_hash);
}

// Must run last.
TEST_F(Stepped, I_EveryRunHasARecordingThatReplays)
{
  const std_srvs::Trigger::Response stopped = client_->trigger("session/stop");
  EXPECT_TRUE(stopped.success);
  const std::filesystem::path first = std::filesystem::path(stopped.message).parent_path().parent_path();
  EXPECT_EQ(replayedHash(first / "session.bag"), hashOfSimulate(scene(), commands(), kSeconds));
  const std::string expected = hashOfSimulate(scene(), commands(), kShort);
  for (const char* run : {"run_2", "run_3", "run_6"})
    EXPECT_EQ(replayedHash(first / run / "session.bag"), expected) << run;
  replayedHash(first / "run_4/session.bag");
  replayedHash(first / "run_5/session.bag");  // from a loaded state
  EXPECT_EQ(replayedHash(first / "run_7/session.bag"), waited_for_recorder_);
  EXPECT_TRUE(client_->step(10).success) << "without a recorder";
}

const auto* const kCallbacks = testing::AddGlobalTestEnvironment(new CallbackThread);

}  // namespace
}  // namespace endovascular_sim
