#include "drive/joint_command.h"

#include <gtest/gtest.h>

namespace endovascular_sim::drive
{
namespace
{

constexpr CommandKind kPosition = CommandKind::kServoPosition;

TEST(JointCommand, OfNamedJointsMayHaveAnyOrderAndOtherNames)
{
  const auto command = jointCommand(kPosition, {"elbow", "rotation", "pressure", "insertion"}, {7.0, 0.2, 3e5, 0.1});
  ASSERT_TRUE(command);
  EXPECT_EQ(command->insertion, 0.1);
  EXPECT_EQ(command->rotation, 0.2);
  EXPECT_EQ(command->pressure, 3e5);
}

TEST(JointCommand, WithoutNamesIsInOrderAndItsLastJointsHold)
{
  const auto one = jointCommand(kPosition, {}, {0.1});
  ASSERT_TRUE(one);
  EXPECT_EQ(one->insertion, 0.1);
  EXPECT_FALSE(one->rotation);
  const auto three = jointCommand(kPosition, {}, {0.1, 0.2, 3e5});
  ASSERT_TRUE(three);
  EXPECT_EQ(three->rotation, 0.2);
  EXPECT_EQ(three->pressure, 3e5);
}

TEST(JointCommand, IsMalformedWithMissingOrRepeatedJoints)
{
  EXPECT_FALSE(jointCommand(kPosition, {}, {}));
  EXPECT_FALSE(jointCommand(kPosition, {}, {0.1, 0.2, 0.3, 0.4}));
  EXPECT_FALSE(jointCommand(kPosition, {"insertion"}, {0.1}));
  EXPECT_FALSE(jointCommand(kPosition, {"insertion", "rotation"}, {0.1}));
  EXPECT_FALSE(jointCommand(kPosition, {"insertion", "rotation"}, {}));
  EXPECT_FALSE(jointCommand(kPosition, {"insertion", "insertion", "rotation"}, {0.1, 0.1, 0.2}));
  EXPECT_FALSE(jointCommand(kPosition, {"joint_1", "joint_2"}, {0.1, 0.2}));
}

TEST(JointCommand, OfVelocitiesOrForcesHasNoPressure)
{
  EXPECT_FALSE(jointCommand(CommandKind::kServoVelocity, {}, {0.1, 0.2, 1e5}));
  const auto velocity = jointCommand(CommandKind::kServoVelocity, {}, {0.1, 0.2, 0.0});
  ASSERT_TRUE(velocity);
  EXPECT_FALSE(velocity->pressure);
}

TEST(JointCommand, KindsHaveTheirCrtkNames)
{
  for (const char* name : {"servo_jp", "servo_jr", "servo_jv", "servo_jf", "move_jp", "move_jr"})
  {
    const auto kind = commandKind(name);
    ASSERT_TRUE(kind) << name;
    EXPECT_STREQ(nameOf(*kind), name);
  }
  EXPECT_FALSE(commandKind("interpolate_jp"));
}

}  // namespace
}  // namespace endovascular_sim::drive
