#include <crtk_msgs/OperatingState.h>
#include <crtk_msgs/StringStamped.h>
#include <gtest/gtest.h>
#include <ros/message_traits.h>

namespace endovascular_sim::nodes
{
namespace
{

TEST(CrtkMessages, AreThoseOfThePublicPackage)
{
  EXPECT_STREQ(ros::message_traits::MD5Sum<crtk_msgs::OperatingState>::value(), "b1bd4021639d9d9c5fbfff78d6ff3158");
  EXPECT_STREQ(ros::message_traits::MD5Sum<crtk_msgs::StringStamped>::value(), "5e3e46086181199270f1ac3a28a5977f");
}

}  // namespace
}  // namespace endovascular_sim::nodes
