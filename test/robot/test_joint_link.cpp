#include "robot/joint_link.h"

#include <gtest/gtest.h>

#include "robot/urdf/urdf_reader.h"

namespace endovascular_sim::robot
{
namespace
{

const RobotModel kModel = parseUrdf(
    "<robot name=\"r\"><link name=\"base\"/><link name=\"a\"/><link name=\"b\"/><link name=\"c\"/><link name=\"d\"/>"
    "<link name=\"e\"/><link name=\"f\"/><link name=\"g\"/>"
    "<joint name=\"slide\" type=\"prismatic\"><parent link=\"base\"/><child link=\"a\"/>"
    "<limit lower=\"0\" upper=\"0.3\" velocity=\"0.1\" effort=\"5\"/></joint>"
    "<joint name=\"roller\" type=\"continuous\"><parent link=\"base\"/><child link=\"b\"/>"
    "<limit velocity=\"20\" effort=\"0.1\"/></joint>"
    "<joint name=\"follower\" type=\"continuous\"><parent link=\"base\"/><child link=\"c\"/>"
    "<mimic joint=\"roller\"/></joint>"
    "<joint name=\"bolt\" type=\"fixed\"><parent link=\"base\"/><child link=\"d\"/></joint>"
    "<joint name=\"hover\" type=\"floating\"><parent link=\"base\"/><child link=\"e\"/></joint>"
    "<joint name=\"stuck\" type=\"revolute\"><parent link=\"base\"/><child link=\"f\"/>"
    "<limit lower=\"-1\" upper=\"1\" velocity=\"0\" effort=\"1\"/></joint>"
    "<joint name=\"closed\" type=\"revolute\"><parent link=\"base\"/><child link=\"g\"/>"
    "<limit velocity=\"1\" effort=\"1\"/></joint></robot>",
    "r.urdf");

JointLink linkOf(const std::string& joint, double ratio = 1.0, double offset = 0.0)
{
  return {joint, "wire", Motion::kInsertion, ratio, offset, 0.0};
}

std::string faultOf(const JointLink& link, double start = 0.1)
{
  const std::optional<LinkFault> fault = findFault(kModel, {link}, {start});
  return fault ? fault->key + ": " + fault->remedy : "";
}

TEST(JointLink, RatioAndOffsetAreInverted)
{
  const JointLink link = linkOf("roller", -0.02, 0.05);
  EXPECT_EQ(link.toMotion(2.5), 0.0);
  for (const double position : {-7.0, 0.0, 0.3, 40.0})
    EXPECT_NEAR(link.toPosition(link.toMotion(position)), position, 1e-13);
}

TEST(JointLink, AValidLinkHasNoFault)
{
  EXPECT_EQ(faultOf(linkOf("slide")), "");
  EXPECT_EQ(faultOf(linkOf("roller", 0.02, -7.0)), "") << "a continuous joint has no limits of its position";
}

TEST(JointLink, JointsThatMoveNothingAreNamed)
{
  EXPECT_NE(faultOf(linkOf("slied")).find("has no joint 'slied'; its movable joints are slide, roller, follower"),
            std::string::npos);
  EXPECT_NE(faultOf(linkOf("bolt")).find("is fixed"), std::string::npos);
  EXPECT_NE(faultOf(linkOf("hover")).find("is planar or floating"), std::string::npos);
  EXPECT_NE(faultOf(linkOf("follower")).find("mimics 'roller'; give that joint"), std::string::npos);
  EXPECT_NE(faultOf(linkOf("stuck")).find("give its largest speed"), std::string::npos);
  EXPECT_NE(faultOf(linkOf("closed")).find("equal limits lower and upper"), std::string::npos);
}

TEST(JointLink, AStartBeyondTheLimitsIsRefusedWithAnOffset)
{
  EXPECT_NE(faultOf(linkOf("slide"), 0.5).find("an offset of 0.5 puts it at its lower limit"), std::string::npos);
  EXPECT_NE(faultOf(linkOf("slide"), -0.1).find("offset: puts joint 'slide' at -0.1"), std::string::npos);
  EXPECT_EQ(faultOf(linkOf("slide", 1.0, -0.1), -0.1), "");
}

TEST(JointLink, LimitsOfTheJointNarrowThoseOfTheInstrument)
{
  const drive::DriveLimits limits = drive::DriveLimits().completed(1.0, 3.0, 0.05);
  JointLink link = linkOf("slide", -0.5, 0.2);
  link.backlash = 0.01;
  const drive::DriveLimits narrowed = withJoint(limits, link, *kModel.find("slide"), 0.2);
  EXPECT_NEAR(narrowed.insertion->low, 0.2 - 0.15 + 0.005, 1e-15);
  EXPECT_EQ(narrowed.insertion->high, 0.2) << "the start stays within";
  EXPECT_NEAR(narrowed.speed, 0.05, 1e-15);
  EXPECT_NEAR(narrowed.approach_speed, 0.05, 1e-15);
  EXPECT_EQ(narrowed.force, 3.0) << "the joint can push with 10 N";
  EXPECT_EQ(narrowed.turning_speed, limits.turning_speed);
  EXPECT_EQ(withJoint(narrowed, link, *kModel.find("slide"), 0.2), narrowed);
}

TEST(JointLink, AContinuousJointLimitsSpeedAndTorqueOnly)
{
  const drive::DriveLimits limits = drive::DriveLimits().completed(1.0, 3.0, 0.05);
  const JointLink link{"roller", "wire", Motion::kRotation, 4.0, 0.0, 0.0};
  const drive::DriveLimits narrowed = withJoint(limits, link, *kModel.find("roller"), 0.0);
  EXPECT_EQ(narrowed.rotation, limits.rotation);
  EXPECT_EQ(narrowed.turning_speed, 60.0) << "smaller than 80 rad/s";
  EXPECT_EQ(narrowed.torque, 0.025);
  EXPECT_EQ(narrowed.insertion, limits.insertion);
}

TEST(JointLink, JointsThatNothingMovesAreListed)
{
  EXPECT_EQ(idleJoints(kModel, {linkOf("slide")}), (std::vector<std::string>{"roller", "stuck", "closed"}));
}

}  // namespace
}  // namespace endovascular_sim::robot
