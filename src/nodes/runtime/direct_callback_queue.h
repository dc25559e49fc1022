#pragma once

#include <ros/callback_queue_interface.h>

namespace endovascular_sim::nodes
{

/** Runs a subscriber's callback at once, in the thread that read the message from the socket.
 *
 *  ROS otherwise hands every message to a second thread; on the path from the rod to the contact node and back each
 * such hand-over costs as much as the detection itself. All subscribers on this queue are called from one thread.
 * Callbacks must be short, and must not subscribe or unsubscribe. */
class DirectCallbackQueue : public ros::CallbackQueueInterface
{
public:
  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t = 0) override { callback->call(); }
  void removeByID(std::uint64_t) override {}
};

}  // namespace endovascular_sim::nodes
