#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>

#include "test/nodes/crtk_client.h"

namespace endovascular_sim
{
namespace
{

constexpr double kSame = 1e-9;
// The robot of test/data/robot_in_tube.yaml.
constexpr double kCatheterOffset = 0.01;
constexpr double kRollerRatio = 0.02, kRollerOffset = 0.03, kRollerPlay = 1e-3;
constexpr double kChuckRatio = 2.0, kChuckPlay = 0.1;

class Robot : public testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    client_ = std::make_unique<CrtkClient>(
        "robot/", "robot",
        std::vector<std::string>{"robot/joint_states", "instruments/wire/measured_js", "instruments/wire/setpoint_js",
                                 "instruments/catheter/measured_js"});
  }
  static void TearDownTestSuite() { client_.reset(); }
  void SetUp() override
  {
    ASSERT_TRUE(client_->enable()) << client_->state().state << " " << client_->reason();
    ASSERT_TRUE(client_->run(0.3)) << "no client drives";
  }

  static std::unique_ptr<CrtkClient> client_;
};

std::unique_ptr<CrtkClient> Robot::client_;

TEST_F(Robot, IsDescribedAndStandsAtTheIntroducer)
{
  std::string description;
  ASSERT_TRUE(ros::NodeHandle().getParam("robot_description", description));
  EXPECT_NE(description.find("<robot name=\"catheter_robot\">"), std::string::npos);
  std::map<std::string, std::string> parents;  // of the static frames
  TopicObserver frames;
  frames.subscribe<tf2_msgs::TFMessage>("/tf_static",
                                        [&parents](const auto& message)
                                        {
                                          for (const auto& transform : message.transforms)
                                            parents[transform.child_frame_id] = transform.header.frame_id;
                                        });
  EXPECT_TRUE(waitUntil(10.0, [&] { return frames.copy(parents)["robot_base"] == "introducer"; }));
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
                             for (const double value : {std::nan(""), HUGE_VAL, -HUGE_VAL})
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
