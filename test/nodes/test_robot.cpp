#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <crtk_msgs/OperatingState.h>
#include <crtk_msgs/StringStamped.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>

#include "endovascular_sim/DriveApplied.h"
#include "test/nodes/graph_testing.h"
#include "test/nodes/topic_observer.h"

namespace endovascular_sim
{
namespace
{

using Joints = sensor_msgs::JointState;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kSame = 1e-9;
// The robot of test/data/robot_in_tube.yaml.
constexpr double kCatheterOffset = 0.01;
constexpr double kRollerRatio = 0.02, kRollerOffset = 0.03, kRollerPlay = 1e-3;
constexpr double kChuckRatio = 2.0, kChuckPlay = 0.1;

Joints positions(std::vector<double> values, std::vector<std::string> names = {})
{
  Joints message;
  message.name = std::move(names);
  message.position = std::move(values);
  return message;
}

Joints velocities(std::vector<double> values, std::vector<std::string> names = {})
{
  Joints message;
  message.name = std::move(names);
  message.velocity = std::move(values);
  return message;
}

/** Client of the robot, which listens to its instruments too. */
class Client
{
public:
  Client()
  {
    for (const char* input : {"servo_jp", "servo_jr", "servo_jv", "servo_jf", "move_jp", "move_jr"})
      inputs_[input] = node_.advertise<Joints>("robot/" + std::string(input), 10);
    command_ = node_.advertise<crtk_msgs::StringStamped>("robot/state_command", 10, true);
    for (const char* topic :
         {"robot/measured_js", "robot/setpoint_js", "robot/goal_js", "robot/joint_states",
          "instruments/wire/measured_js", "instruments/catheter/measured_js", "instruments/wire/setpoint_js"})
      observer_.subscribe<Joints>(
          topic, [this, topic](const Joints& joints) { joints_[topic][joints.header.stamp.toNSec()] = joints; });
    observer_.subscribe<crtk_msgs::OperatingState>("robot/operating_state",
                                                   [this](const auto& state)
                                                   {
                                                     state_ = state;
                                                     busy_states_ += state.is_busy;
                                                   });
    observer_.subscribe<crtk_msgs::StringStamped>("robot/state_reason",
                                                  [this](const auto& reason) { reason_ = reason.string; });
    observer_.subscribe<geometry_msgs::PoseStamped>("robot/measured_cp", [this](const auto& pose) { tip_ = pose; });
    observer_.subscribe<geometry_msgs::WrenchStamped>("robot/measured_cf",
                                                      [this](const auto& force) { wall_force_ = force; });
    observer_.subscribe<tf2_msgs::TFMessage>("/tf_static",
                                             [this](const auto& message)
                                             {
                                               for (const auto& transform : message.transforms)
                                                 parents_[transform.child_frame_id] = transform.header.frame_id;
                                             });
    observer_.subscribe<diagnostic_msgs::DiagnosticArray>(
        "/diagnostics", [this](const auto& array) { takeDiagnostics(array, "robot", diagnostics_); });
    observer_.subscribe<DriveApplied>("drive/applied", [this](const auto& step) { step_ = step.step; });
  }

  void send(const std::string& input, const Joints& joints) { inputs_.at(input).publish(joints); }

  void command(const std::string& word)
  {
    crtk_msgs::StringStamped message;
    message.string = word;
    command_.publish(message);
  }

  /** Simulates for a time. @param each called about every 5 ms [s] */
  bool run(
      double seconds, const std::function<void()>& each = [] {})
  {
    const double end = time() + seconds;
    return waitUntil(60.0,
                     [&]
                     {
                       each();
                       return time() >= end;
                     });
  }

  /** Sends a move and waits for its end. */
  bool move(const Joints& joints)
  {
    const std::uint64_t busy = observer_.copy(busy_states_);
    send("move_jp", joints);
    return waitUntil(10.0, [&] { return observer_.copy(busy_states_) > busy; }) &&
           waitUntil(60.0, [this] { return !state().is_busy; }) && run(0.05);
  }

  double time() const { return 1e-3 * static_cast<double>(observer_.copy(step_)); }
  crtk_msgs::OperatingState state() const { return observer_.copy(state_); }
  std::string reason() const { return observer_.copy(reason_); }
  std::string diagnostics() const { return observer_.copy(diagnostics_); }
  geometry_msgs::PoseStamped tip() const { return observer_.copy(tip_); }
  geometry_msgs::WrenchStamped wallForce() const { return observer_.copy(wall_force_); }
  std::map<std::string, std::string> parents() const { return observer_.copy(parents_); }
  std::map<std::uint64_t, Joints> all(const std::string& topic) const
  {
    const std::lock_guard<std::mutex> lock(observer_.mutex());
    return joints_.count(topic) > 0 ? joints_.at(topic) : std::map<std::uint64_t, Joints>();
  }
  Joints newest(const std::string& topic) const
  {
    const std::map<std::uint64_t, Joints> messages = all(topic);
    return messages.empty() ? Joints() : messages.rbegin()->second;
  }
  /** Newest position of a joint. */
  double position(const std::string& topic, std::size_t joint) const
  {
    const Joints joints = newest(topic);
    return joint < joints.position.size() ? joints.position[joint] : kNan;
  }

private:
  ros::NodeHandle node_;
  std::map<std::string, ros::Publisher> inputs_;
  ros::Publisher command_;
  std::map<std::string, std::map<std::uint64_t, Joints>> joints_;  ///< by topic and stamp [ns]
  std::map<std::string, std::string> parents_;                     ///< of the static frames
  crtk_msgs::OperatingState state_;
  std::uint64_t busy_states_ = 0;
  std::uint64_t step_ = 0;
  std::string reason_, diagnostics_;
  geometry_msgs::PoseStamped tip_;
  geometry_msgs::WrenchStamped wall_force_;
  TopicObserver observer_;  ///< last, so that it ends before the data that it takes over
};

class Robot : public testing::Test
{
protected:
  static void SetUpTestSuite() { client_ = std::make_unique<Client>(); }
  static void TearDownTestSuite() { client_.reset(); }
  void SetUp() override
  {
    ASSERT_TRUE(waitUntil(90.0, [] { return client_->time() > 0.1; })) << "the simulation runs";
    for (const char* word : {"resume", "enable", "home"})
      client_->command(word);
    ASSERT_TRUE(waitUntil(30.0,
                          []
                          {
                            const crtk_msgs::OperatingState state = client_->state();
                            return state.state == "ENABLED" && state.is_homed && !state.is_busy;
                          }))
        << client_->state().state << " " << client_->reason();
    ASSERT_TRUE(client_->run(0.3)) << "no client drives";
  }

  static std::unique_ptr<Client> client_;
};

std::unique_ptr<Client> Robot::client_;

TEST_F(Robot, IsDescribedAndStandsAtTheIntroducer)
{
  std::string description;
  ASSERT_TRUE(ros::NodeHandle().getParam("robot_description", description));
  EXPECT_NE(description.find("<robot name=\"catheter_robot\">"), std::string::npos);
  EXPECT_TRUE(waitUntil(10.0, [] { return client_->parents()["robot_base"] == "introducer"; }));
}

TEST_F(Robot, AnUnnamedStreamMovesAllInstrumentsThroughRatioAndBacklash)
{
  const Joints start = client_->newest("robot/measured_js");
  ASSERT_EQ(start.name, (std::vector<std::string>{"catheter_carriage", "catheter_chuck", "wire_roller", "wire_chuck"}));
  std::vector<double> goal = start.position;
  ASSERT_TRUE(client_->run(1.0,
                           [&]
                           {
                             goal[0] = std::min(goal[0] + 1e-4, 0.01);
                             goal[1] = std::min(goal[1] + 5e-3, 0.4);
                             goal[2] = std::min(goal[2] + 5e-3, 0.5);
                             goal[3] = std::min(goal[3] + 5e-3, 0.3);
                             client_->send("servo_jp", positions(goal));
                           }));
  ASSERT_TRUE(client_->run(0.1));
  EXPECT_NEAR(client_->position("instruments/catheter/measured_js", 0), kCatheterOffset + goal[0], 1e-4);
  EXPECT_NEAR(client_->position("instruments/catheter/measured_js", 1), -goal[1], 1e-3);
  EXPECT_NEAR(client_->position("instruments/wire/setpoint_js", 0),
              kRollerOffset + kRollerRatio * goal[2] - 0.5 * kRollerPlay, kSame);
  EXPECT_NEAR(client_->position("instruments/wire/setpoint_js", 1), kChuckRatio * goal[3] - 0.5 * kChuckPlay, kSame);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_NEAR(client_->position("robot/setpoint_js", k), goal[k], kSame) << k;
}

TEST_F(Robot, AReversalWithinTheBacklashMovesTheJointOnly)
{
  ASSERT_TRUE(client_->move(positions({0.5}, {"wire_roller"})));
  ASSERT_TRUE(client_->move(positions({0.6}, {"wire_roller"})));
  const double wire = client_->position("instruments/wire/setpoint_js", 0);
  EXPECT_NEAR(wire, kRollerOffset + 0.6 * kRollerRatio - 0.5 * kRollerPlay, kSame);
  ASSERT_TRUE(client_->move(positions({0.6 - 0.9 * kRollerPlay / kRollerRatio}, {"wire_roller"})));
  EXPECT_NEAR(client_->position("instruments/wire/setpoint_js", 0), wire, kSame);
  EXPECT_NEAR(client_->position("robot/setpoint_js", 2), 0.6 - 0.9 * kRollerPlay / kRollerRatio, kSame);
  ASSERT_TRUE(client_->move(positions({0.5}, {"wire_roller"})));
  EXPECT_NEAR(client_->position("instruments/wire/setpoint_js", 0),
              kRollerOffset + 0.5 * kRollerRatio + 0.5 * kRollerPlay, kSame);
}

TEST_F(Robot, NamedJointsMoveTheirInstrumentsOnly)
{
  const double wire = client_->position("instruments/wire/measured_js", 0);
  ASSERT_TRUE(client_->move(positions({0.3, 0.02}, {"catheter_chuck", "catheter_carriage"})));
  EXPECT_NEAR(client_->position("instruments/catheter/measured_js", 0), kCatheterOffset + 0.02, 1e-3);
  EXPECT_NEAR(client_->position("instruments/catheter/measured_js", 1), -0.3, 1e-3);
  EXPECT_NEAR(client_->position("instruments/wire/measured_js", 0), wire, 1e-4);
  EXPECT_NEAR(client_->position("robot/goal_js", 0), 0.02, kSame);
}

TEST_F(Robot, VelocitiesMoveTheJointsAndEndWithTheirClient)
{
  const double before = client_->position("robot/measured_js", 0);
  ASSERT_TRUE(client_->run(0.5, [] { client_->send("servo_jv", velocities({0.01, -0.5})); }));
  EXPECT_NEAR(client_->newest("robot/measured_js").velocity.at(0), 0.01, 4e-3);
  EXPECT_NEAR(client_->position("robot/measured_js", 0) - before, 0.005, 2e-3);
  ASSERT_TRUE(client_->run(0.4));
  const double rest = client_->position("robot/setpoint_js", 0);
  ASSERT_TRUE(client_->run(0.3));
  EXPECT_EQ(client_->position("robot/setpoint_js", 0), rest);
}

TEST_F(Robot, CommandsBeyondTheUrdfAreRejectedWithTheReason)
{
  const double before = client_->position("robot/setpoint_js", 0);
  client_->send("move_jp", positions({0.31}));
  EXPECT_TRUE(waitUntil(
      20.0, []
      { return client_->diagnostics().find("0.31 is beyond the limits 0 to 0.3 of the URDF") != std::string::npos; }))
      << client_->diagnostics();
  EXPECT_EQ(client_->position("robot/setpoint_js", 0), before);
}

TEST_F(Robot, AVelocityEndsAtTheRangeOfTheJoint)
{
  ASSERT_TRUE(client_->move(positions({0.02})));
  ASSERT_TRUE(client_->run(1.0, [] { client_->send("servo_jv", velocities({-0.05})); }));
  EXPECT_NEAR(client_->position("robot/setpoint_js", 0), 0.0, kSame);
}

TEST_F(Robot, NonsenseIsIgnored)
{
  const Joints before = client_->newest("robot/setpoint_js");
  ASSERT_TRUE(client_->run(0.5,
                           []
                           {
                             for (const double value : {kNan, HUGE_VAL, -HUGE_VAL})
                               for (const char* input : {"servo_jp", "servo_jr", "move_jp", "move_jr"})
                                 client_->send(input, positions({value, 0.1}));
                             client_->send("servo_jp", positions({0.1, 0.1, 0.1, 0.1, 0.1}));
                             client_->send("servo_jp", positions({}));
                             client_->send("servo_jp", positions({1e300, 1e300, 1e300, 1e300}));
                             client_->send("servo_jv", velocities({1e300}));
                             client_->send("servo_jp", positions({0.1}, {"elbow"}));
                             client_->command("dance");
                           }));
  EXPECT_EQ(client_->newest("robot/setpoint_js").position, before.position);
  EXPECT_NE(client_->state().state, "FAULT");
  ASSERT_TRUE(client_->run(0.5, [] { client_->send("servo_jr", positions({1e-4})); }));
  EXPECT_GT(client_->position("robot/setpoint_js", 0), before.position.at(0) + 1e-3) << "the next sane command";
}

TEST_F(Robot, StateCommandsGoToAllInstruments)
{
  client_->command("pause");
  ASSERT_TRUE(waitUntil(10.0, [] { return client_->state().state == "PAUSED"; }));
  EXPECT_TRUE(waitUntil(10.0, [] { return client_->reason().find("paused by /robot") != std::string::npos; }))
      << client_->reason();
  const double before = client_->position("robot/setpoint_js", 0);
  ASSERT_TRUE(client_->run(0.3, [] { client_->send("servo_jr", positions({1e-4})); }));
  EXPECT_EQ(client_->position("robot/setpoint_js", 0), before);
  client_->command("resume");
  ASSERT_TRUE(waitUntil(10.0, [] { return client_->state().state == "ENABLED"; }));
  client_->command("unhome");
  EXPECT_TRUE(waitUntil(10.0, [] { return !client_->state().is_homed; }));
}

TEST_F(Robot, PassesTipAndWallForceOfItsFirstInstrument)
{
  ASSERT_TRUE(client_->move(positions({0.03})));
  ASSERT_TRUE(waitUntil(10.0, [] { return std::abs(client_->tip().pose.position.z - 0.04) < 0.01; }))
      << client_->tip().pose.position.z;
  EXPECT_EQ(client_->tip().header.frame_id, "patient");
  EXPECT_EQ(client_->wallForce().header.frame_id, "patient");
}

TEST_F(Robot, JointStatesContainTheMimicJoint)
{
  const Joints joints = client_->newest("robot/joint_states");
  ASSERT_EQ(joints.name, (std::vector<std::string>{"catheter_carriage", "catheter_chuck", "wire_roller",
                                                   "wire_roller_follower", "wire_chuck"}));
  EXPECT_EQ(joints.position.at(3), -joints.position.at(2));
  EXPECT_EQ(joints.velocity.at(3), -joints.velocity.at(2));
}

/** Last: all measurements of the tests above. */
TEST_F(Robot, Z_MeasuredJointsAreThoseOfTheInstruments)
{
  const std::map<std::uint64_t, Joints> robot = client_->all("robot/measured_js");
  const std::map<std::uint64_t, Joints> wires = client_->all("instruments/wire/measured_js");
  const std::map<std::uint64_t, Joints> catheters = client_->all("instruments/catheter/measured_js");
  std::size_t compared = 0;
  for (const auto& [stamp, joints] : robot)
  {
    if (wires.count(stamp) == 0 || catheters.count(stamp) == 0)
      continue;
    ++compared;
    const Joints& wire = wires.at(stamp);
    const Joints& catheter = catheters.at(stamp);
    ASSERT_NEAR(joints.position.at(0), catheter.position.at(0) - kCatheterOffset, kSame);
    ASSERT_NEAR(joints.position.at(1), -catheter.position.at(1), kSame);
    ASSERT_LE(std::abs(kRollerOffset + kRollerRatio * joints.position.at(2) - wire.position.at(0)),
              0.5 * kRollerPlay + kSame);
    ASSERT_LE(std::abs(kChuckRatio * joints.position.at(3) - wire.position.at(1)), 0.5 * kChuckPlay + kSame);
    ASSERT_NEAR(joints.velocity.at(2), wire.velocity.at(0) / kRollerRatio, kSame);
    ASSERT_NEAR(joints.effort.at(1), -catheter.effort.at(1), kSame);
    ASSERT_NEAR(joints.effort.at(2), kRollerRatio * wire.effort.at(0), kSame);
  }
  EXPECT_GT(compared, robot.size() / 2);
  EXPECT_GT(compared, 1000U);
}

}  // namespace
}  // namespace endovascular_sim

int main(int argc, char** argv)
{
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "robot_client");
  return RUN_ALL_TESTS();
}
