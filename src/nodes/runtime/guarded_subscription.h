#pragma once

#include <exception>
#include <string>
#include <type_traits>
#include <utility>

#include <ros/ros.h>
#include <boost/make_shared.hpp>

#include "nodes/runtime/checked_stream.h"
#include "nodes/runtime/ignored_messages.h"

namespace endovascular_sim::nodes
{

/** Callback of a subscription that no message can end the process with. Damaged bytes, and messages for which the
 *  callback throws an exception, are ignored and reported (IgnoredMessages).
 *  @tparam Parameter of the callback, as roscpp permits it */
template <typename Parameter>
class GuardedCallback : public ros::SubscriptionCallbackHelperT<Parameter>
{
  using Base = ros::SubscriptionCallbackHelperT<Parameter>;

public:
  /** @param topic resolved name
   *  @param create creates the message that is filled */
  GuardedCallback(std::string topic, const typename Base::Callback& callback,
                  const typename Base::CreateFunction& create)
    : Base(callback, create), topic_(std::move(topic)), create_message_(create)
  {
  }

  ros::VoidConstPtr deserialize(const ros::SubscriptionCallbackHelperDeserializeParams& bytes) override
  {
    try
    {
      const typename Base::NonConstTypePtr message = create_message_();
      CheckedStream(bytes.buffer, bytes.length).readAll(*message);
      return message;
    }
    catch (const std::exception& error)
    {
      IgnoredMessages::ofProcess().add(topic_, error.what());
      return {};
    }
  }

  void call(ros::SubscriptionCallbackHelperCallParams& parameters) override
  {
    try
    {
      Base::call(parameters);
    }
    catch (const std::exception& error)
    {
      IgnoredMessages::ofProcess().add(topic_, error.what());
    }
  }

private:
  std::string topic_;
  typename Base::CreateFunction create_message_;
};

/** Subscribes to a topic without Nagle's delay. Every subscription of this package ends here: invalid messages are
 *  ignored (GuardedCallback).
 *  @param queue of the callback; null: that of the node handle
 *  @param create creates the message that is filled */
template <typename Parameter>
ros::Subscriber subscribeGuardedAs(ros::NodeHandle node, const std::string& topic, std::uint32_t length,
                                   const boost::function<void(Parameter)>& callback,
                                   ros::CallbackQueueInterface* queue = nullptr,
                                   const typename ros::SubscriptionCallbackHelperT<Parameter>::CreateFunction& create =
                                       ros::DefaultMessageCreator<typename ros::ParameterAdapter<Parameter>::Message>())
{
  ros::SubscribeOptions options;
  options.initByFullCallbackType<Parameter>(topic, length, callback, create);
  options.helper = boost::make_shared<GuardedCallback<Parameter>>(node.resolveName(topic), callback, create);
  options.callback_queue = queue;
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  return node.subscribe(options);
}

/** The same for a callback that takes the message, a shared pointer to it, or its event. It throws an exception to
 *  refuse the message. */
template <typename Message, typename Callback>
ros::Subscriber subscribeGuarded(const ros::NodeHandle& node, const std::string& topic, std::uint32_t length,
                                 Callback callback, ros::CallbackQueueInterface* queue = nullptr)
{
  using Event = const ros::MessageEvent<Message const>&;
  const boost::function<void(Event)> call = [callback = std::move(callback)](Event event)
  {
    if constexpr (std::is_invocable_v<const Callback&, Event>)
      callback(event);
    else if constexpr (std::is_invocable_v<const Callback&, const boost::shared_ptr<Message const>&>)
      callback(event.getConstMessage());
    else
      callback(*event.getConstMessage());
  };
  return subscribeGuardedAs<Event>(node, topic, length, call, queue);
}

}  // namespace endovascular_sim::nodes
