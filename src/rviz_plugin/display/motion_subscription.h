#pragma once

#include <string>

#include <ros/subscriber.h>

namespace ros
{
class NodeHandle;
}

namespace endovascular_sim::rviz_plugin
{

class MotionFollower;

/** Subscribes to the motion of the patient. The queue holds all motions of a slow frame.
 *  @param topic empty: none, the patient rests
 *  @param follower outlives the subscription */
ros::Subscriber subscribeToMotion(const ros::NodeHandle& node, const std::string& topic, MotionFollower& follower);

}  // namespace endovascular_sim::rviz_plugin
