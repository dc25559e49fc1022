#pragma once

#include <string>

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include "nodes/runtime/guarded_subscription.h"

namespace endovascular_sim::nodes
{

/** Waits for a valid message of a latched topic.
 *
 *  roscpp can lose a latched message to a subscriber that connects while it is published. The subscription is therefore
 *  renewed every 5 s of the steady clock, which simulated time does not stop.
 *  @param take takes the message over; throws an exception to refuse it, and the next one is waited for
 *  @return false when the node ends before */
template <typename Message, typename Take>
bool waitForLatched(const ros::NodeHandle& node, const std::string& topic, const Take& take)
{
  constexpr double kRenewal = 5.0;  // s
  constexpr double kPoll = 0.1;     // s
  ros::CallbackQueue queue;
  bool is_taken = false;
  while (ros::ok() && !is_taken)
  {
    const ros::Subscriber subscriber = subscribeGuarded<Message>(
        node, topic, 1,
        [&is_taken, &take](const Message& message)
        {
          take(message);
          is_taken = true;
        },
        &queue);
    const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(kRenewal);
    while (ros::ok() && !is_taken && ros::SteadyTime::now() < end)
      queue.callAvailable(ros::WallDuration(kPoll));
  }
  return is_taken;
}

}  // namespace endovascular_sim::nodes
