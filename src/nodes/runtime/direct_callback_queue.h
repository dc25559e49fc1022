#pragma once

#include <ros/callback_queue_interface.h>

namespace endovascular_sim::nodes
{

/** Callback queue that runs a subscriber's callback at once, in the thread that read the message from the socket.
 *
 *  The default queue passes every message to a second thread. On the path between the rod and the contact node this
 *  costs as much as the detection itself. All subscribers on one such queue are called from one thread. Callbacks must
 * be short, and must not subscribe or unsubscribe. */
class DirectCallbackQueue : public ros::CallbackQueueInterface
{
public:
  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t = 0) override { callback->call(); }
  void removeByID(std::uint64_t) override {}
};

}  // namespace endovascular_sim::nodes
