#pragma once

#include <vector>

#include <geometry_msgs/Wrench.h>
#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/JointState.h>

#include "endovascular_sim/HapticForce.h"
#include "endovascular_sim/HapticSample.h"
#include "haptics/rosserial/topic_registry.h"

namespace endovascular_sim::nodes
{

/** ROS message type in the representation of the rosserial host. */
template <typename Message>
haptics::TopicType topicType(haptics::PayloadFormat format)
{
  return {format, ros::message_traits::datatype<Message>(), ros::message_traits::md5sum<Message>()};
}

/** All message types that a haptic device may publish or subscribe to. */
inline std::vector<haptics::TopicType> hapticTopicTypes()
{
  using haptics::PayloadFormat;
  return {topicType<HapticSample>(PayloadFormat::kHapticSample),
          topicType<sensor_msgs::JointState>(PayloadFormat::kJointState),
          topicType<HapticForce>(PayloadFormat::kHapticForce), topicType<geometry_msgs::Wrench>(PayloadFormat::kWrench),
          topicType<geometry_msgs::WrenchStamped>(PayloadFormat::kWrenchStamped)};
}

}  // namespace endovascular_sim::nodes
