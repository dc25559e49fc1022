#include "nodes/conversions/robot_conversions.h"

#include <gtest/gtest.h>

#include "scene/scene_file.h"

namespace endovascular_sim::nodes
{
namespace
{

/** Scene of the tests, loaded at its first use. */
const scene::Scene& robotScene()
{
  static const scene::Scene scene = scene::loadScene(TEST_DATA_DIR "/robot_in_tube.yaml");
  return scene;
}

/** Joints of an instrument with velocities and efforts. */
sensor_msgs::JointState jointsAt(double insertion, double rotation)
{
  sensor_msgs::JointState joints;
  joints.header.stamp = ros::Time(3.0);
  joints.name = {"insertion", "rotation"};
  joints.position = {insertion, rotation};
  joints.velocity = {0.02, 0.4};
  joints.effort = {0.5, 0.003};
  return joints;
}

TEST(RobotConversions, JointsOfInstrumentsBecomeThoseOfTheRobot)
{
  const robot::RobotControl control = robotControl(robotScene());
  ASSERT_EQ(control.instruments().size(), 2U);
  ASSERT_EQ(control.instruments()[0].name, "catheter") << "in the order of the joints";
  sensor_msgs::JointState joints;
  toMessage(control, {jointsAt(0.05, 0.3), jointsAt(0.04, 0.2)}, joints);
  EXPECT_EQ(joints.header.stamp, ros::Time(3.0));
  EXPECT_EQ(joints.name,
            (std::vector<std::string>{"catheter_carriage", "catheter_chuck", "wire_roller", "wire_chuck"}));
  EXPECT_NEAR(joints.position.at(0), 0.04, 1e-15);
  EXPECT_EQ(joints.position.at(1), -0.3);
  EXPECT_NEAR(joints.position.at(2), (0.01 - 0.5e-3) / 0.02, 1e-12) << "at the near end of its play";
  EXPECT_NEAR(joints.velocity.at(2), 1.0, 1e-15);
  EXPECT_NEAR(joints.effort.at(2), 0.01, 1e-15);
  EXPECT_EQ(joints.velocity.at(3), 0.2);
  EXPECT_EQ(joints.effort.at(1), -0.003);
  sensor_msgs::JointState all;
  toAllJoints(control, joints, all);
  EXPECT_EQ(all.name.size(), 5U);
  EXPECT_EQ(all.position.at(3), -all.position.at(2)) << "the follower";
}

TEST(RobotConversions, AGoalHasNeitherVelocityNorEffort)
{
  const robot::RobotControl control = robotControl(robotScene());
  sensor_msgs::JointState goal = jointsAt(0.05, 0.3);
  goal.velocity.clear();
  goal.effort.clear();
  sensor_msgs::JointState joints;
  toMessage(control, {goal, goal}, joints);
  EXPECT_EQ(joints.position.size(), 4U);
  EXPECT_TRUE(joints.velocity.empty());
  EXPECT_TRUE(joints.effort.empty());
}

TEST(RobotConversions, CommandsHaveTheFieldsOfTheirKind)
{
  using drive::CommandKind;
  EXPECT_EQ(toMessage({CommandKind::kServoPosition, 0.1, 0.2, 3e5}).position, (std::vector<double>{0.1, 0.2, 3e5}));
  EXPECT_EQ(toMessage({CommandKind::kServoVelocity, 0.1, std::nullopt, std::nullopt}).velocity,
            (std::vector<double>{0.1}));
  EXPECT_EQ(toMessage({CommandKind::kServoForce, 0.1, 0.2, std::nullopt}).effort, (std::vector<double>{0.1, 0.2}));
}

TEST(RobotConversions, ThePoseIsThatOfTheScene)
{
  scene::RobotScene robot = *robotScene().robot;
  robot.position = {0.1, 0.2, 0.3};
  robot.rpy = {0.0, 0.0, M_PI_2};
  const geometry_msgs::TransformStamped transform = toTransform(robot);
  EXPECT_EQ(transform.header.frame_id, "introducer");
  EXPECT_EQ(transform.child_frame_id, "robot_base");
  EXPECT_EQ(transform.transform.translation.y, 0.2);
  EXPECT_NEAR(transform.transform.rotation.z, std::sqrt(0.5), 1e-15);
}

}  // namespace
}  // namespace endovascular_sim::nodes
