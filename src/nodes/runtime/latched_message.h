#pragma once

#include <string>

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <boost/shared_ptr.hpp>

namespace endovascular_sim::nodes
{

/** Waits for the message of a latched topic.
 *
 *  roscpp can lose a latched message to a subscriber that connects while it is published. The subscription is therefore
 *  renewed every 5 s of the steady clock, which simulated time does not stop.
 *  @return null when the node ends before */
template <typename Message>
boost::shared_ptr<const Message> waitForLatched(const ros::NodeHandle& node, const std::string& topic)
{
  constexpr double kRenewal = 5.0;  // s
  constexpr double kPoll = 0.1;     // s
  ros::CallbackQueue queue;
  ros::NodeHandle direct(node);
  direct.setCallbackQueue(&queue);
  boost::shared_ptr<const Message> message;
  while (ros::ok() && !message)
  {
    const ros::Subscriber subscriber = direct.subscribe<Message>(
        topic, 1, [&message](const boost::shared_ptr<const Message>& received) { message = received; });
    const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(kRenewal);
    while (ros::ok() && !message && ros::SteadyTime::now() < end)
      queue.callAvailable(ros::WallDuration(kPoll));
  }
  return message;
}

}  // namespace endovascular_sim::nodes
