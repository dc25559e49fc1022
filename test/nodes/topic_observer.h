#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>

namespace endovascular_sim
{

/** Subscriptions of a test, whose data a thread of their own takes over. Declare it after those data, so that the
 *  thread ends first. */
class TopicObserver
{
public:
  TopicObserver() { spinner_.start(); }

  /** @param take called for each message, with the data locked */
  template <typename Message>
  void subscribe(const std::string& topic, std::function<void(const Message&)> take)
  {
    const boost::function<void(const boost::shared_ptr<Message const>&)> callback =
        [this, take](const boost::shared_ptr<Message const>& message)
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      take(*message);
    };
    subscribers_.push_back(
        node_.subscribe<Message>(topic, 20000, callback, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
  }

  /** Lock of the data. */
  std::mutex& mutex() const { return mutex_; }

  /** Copy of some of the data. */
  template <typename Value>
  Value copy(const Value& value) const
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return value;
  }

private:
  ros::NodeHandle node_;
  mutable std::mutex mutex_;
  std::vector<ros::Subscriber> subscribers_;
  ros::AsyncSpinner spinner_{1};
};

/** Message and values of a node's status as lines; keeps the last ones if the array lacks it.
 *  @param node part of the status' name */
inline void takeDiagnostics(const diagnostic_msgs::DiagnosticArray& array, const std::string& node, std::string& text)
{
  for (const diagnostic_msgs::DiagnosticStatus& status : array.status)
    if (status.name.find(node) != std::string::npos)
    {
      text = status.message;
      for (const diagnostic_msgs::KeyValue& value : status.values)
        text += "\n" + value.key + ": " + value.value;
    }
}

}  // namespace endovascular_sim
