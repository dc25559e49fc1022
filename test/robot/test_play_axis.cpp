#include "robot/play_axis.h"

#include <gtest/gtest.h>

namespace endovascular_sim::robot
{
namespace
{

using drive::CommandKind;

/** Joint whose motion moves the instrument twice as far, with a play of 2 mm. */
JointLink joint()
{
  JointLink link;
  link.ratio = 2.0;
  link.backlash = 2e-3;
  return link;
}

TEST(PlayAxis, UsesUpThePlayBeforeAPositionMovesTheInstrument)
{
  PlayAxis axis;
  axis.link = 0;
  EXPECT_EQ(axis.command(joint(), CommandKind::kServoPosition, 0.4e-3), 0.0);
  EXPECT_NEAR(axis.command(joint(), CommandKind::kServoPosition, 1.5e-3), 2e-3, 1e-15);
}

TEST(PlayAxis, MovesTheJointAloneUntilAVelocityHasUsedUpThePlay)
{
  PlayAxis axis;
  axis.link = 0;
  EXPECT_EQ(axis.command(joint(), CommandKind::kServoVelocity, 0.05), 0.1);
  EXPECT_FALSE(axis.engaged);
  int steps = 1;
  while (!axis.follow(0.0, CommandKind::kServoVelocity, false, 1e-3, joint().backlash))
    ASSERT_LT(++steps, 20);
  EXPECT_EQ(steps, 10);  // 1 mm at 0.1 m/s
  EXPECT_TRUE(axis.engaged);
}

}  // namespace
}  // namespace endovascular_sim::robot
