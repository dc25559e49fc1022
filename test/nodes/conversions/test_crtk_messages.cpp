#include <crtk_msgs/CartesianImpedance.h>
#include <crtk_msgs/CartesianImpedanceHalfPlaneGains.h>
#include <crtk_msgs/CartesianServo.h>
#include <crtk_msgs/CartesianState.h>
#include <crtk_msgs/JointServo.h>
#include <crtk_msgs/OperatingState.h>
#include <crtk_msgs/QueryForwardKinematics.h>
#include <crtk_msgs/QueryInverseKinematics.h>
#include <crtk_msgs/SetpointMode.h>
#include <crtk_msgs/StringStamped.h>
#include <crtk_msgs/TriggerOperatingState.h>
#include <gtest/gtest.h>
#include <ros/message_traits.h>
#include <ros/service_traits.h>

namespace endovascular_sim::nodes
{
namespace
{

TEST(CrtkMessages, AreThoseOfThePublicPackage)
{
  EXPECT_STREQ(ros::message_traits::MD5Sum<crtk_msgs::CartesianImpedance>::value(), "59675c5b57c990d0b76f7f0c9954d4f3");
  EXPECT_STREQ(ros::message_traits::MD5Sum<crtk_msgs::CartesianImpedanceHalfPlaneGains>::value(),
               "b8790a9e2c72de6fc930123c128d3b77");
  EXPECT_STREQ(ros::message_traits::MD5Sum<crtk_msgs::CartesianServo>::value(), "6a249c3960a5b413513e5f1e23a82d6d");
  EXPECT_STREQ(ros::message_traits::MD5Sum<crtk_msgs::CartesianState>::value(), "3913bf7ef8bcc8fa7a8eb33a46f273db");
  EXPECT_STREQ(ros::message_traits::MD5Sum<crtk_msgs::JointServo>::value(), "660a5227424e1ddeb4a13710d9166974");
  EXPECT_STREQ(ros::message_traits::MD5Sum<crtk_msgs::OperatingState>::value(), "b1bd4021639d9d9c5fbfff78d6ff3158");
  EXPECT_STREQ(ros::message_traits::MD5Sum<crtk_msgs::SetpointMode>::value(), "45488f3061f396e81b1a70a7e6acdfa4");
  EXPECT_STREQ(ros::message_traits::MD5Sum<crtk_msgs::StringStamped>::value(), "5e3e46086181199270f1ac3a28a5977f");
  EXPECT_STREQ(ros::service_traits::MD5Sum<crtk_msgs::QueryForwardKinematics>::value(),
               "787c6da7a75e9886573c4af11f1a381f");
  EXPECT_STREQ(ros::service_traits::MD5Sum<crtk_msgs::QueryInverseKinematics>::value(),
               "ce8dbc3b4384e2f7567488e7e75496d8");
  EXPECT_STREQ(ros::service_traits::MD5Sum<crtk_msgs::TriggerOperatingState>::value(),
               "d941a2d049e2c9ac5773fc4a3a8a892d");
}

}  // namespace
}  // namespace endovascular_sim::nodes
