#include "nodes/conversions/operating_state_conversions.h"

#include <gtest/gtest.h>

namespace endovascular_sim::nodes
{
namespace
{

TEST(OperatingStateConversions, KeepStateHomedAndBusy)
{
  const drive::ControlState state{drive::OperatingState::kPaused, false, true, "reason", 3};
  const crtk_msgs::OperatingState message = toMessage(state, ros::Time(2.5));
  EXPECT_EQ(message.state, "PAUSED");
  EXPECT_EQ(message.header.stamp, ros::Time(2.5));
  drive::ControlState read;
  fromMessage(message, read);
  EXPECT_EQ(read.state, state.state);
  EXPECT_FALSE(read.is_homed);
  EXPECT_TRUE(read.is_busy);
  EXPECT_EQ(reasonMessage("why", ros::Time(1.0)).string, "why");
}

TEST(OperatingStateConversions, AStateThatCrtkDoesNotDefineIsAFault)
{
  crtk_msgs::OperatingState message;
  message.state = "SLEEPING";
  drive::ControlState read;
  fromMessage(message, read);
  EXPECT_EQ(read.state, drive::OperatingState::kFault);
}

}  // namespace
}  // namespace endovascular_sim::nodes
