#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <ros/ros.h>
#include <boost/make_shared.hpp>

#include "nodes/rod_dynamics/control/loop_costs.h"
#include "nodes/runtime/direct_callback_queue.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ignored_messages.h"
#include "nodes/runtime/line/local_line.h"
#include "nodes/runtime/line/message_frame.h"

namespace endovascular_sim::nodes
{

/** Queries to another node and its responses, over a local line or two topics. One thread queries.
 *
 *  A node of the same machine offers a local line, which carries the messages of the topics at a fraction of their
 *  cost. With it, queries are published for further subscribers only, and responses from the topic are ignored. */
template <typename Query, typename Response>
class QueryChannel
{
public:
  using Clock = std::chrono::steady_clock;

  /** Takes a response over. It is called in the thread that queries or in one of ROS, with the data of accessed()
   *  locked.
   *  @param is_answered true when the query has a response already
   *  @return true for the response to the last query */
  using Accept = std::function<bool(Response& message, bool is_answered)>;

  /** @param query_topic, response_topic names; the line has that of the response
   *  @param length of the topics' queues
   *  @param costs of the loop that queries; must outlive this object */
  QueryChannel(const ros::NodeHandle& node, const char* query_topic, const char* response_topic, std::uint32_t length,
               LoopCosts& costs, Accept accept)
    : node_(node),
      response_topic_(response_topic),
      costs_(costs),
      line_(lineName(ros::master::getURI(), node_.resolveName(response_topic))),
      accept_(std::move(accept)),
      publisher_(node_.advertise<Query>(query_topic, length))
  {
    subscriber_ = subscribeGuardedAs<const boost::shared_ptr<Response>&>(
        node_, response_topic, length,
        [this](const boost::shared_ptr<Response>& message)
        {
          if (!line_.isConnected())
            receive(*message);
        },
        &queue_, [this] { return emptyMessage(); });
  }
  QueryChannel(const QueryChannel&) = delete;
  QueryChannel& operator=(const QueryChannel&) = delete;

  /** Sends the first message of a query.
   *  @param fill sets the message, and what responses are compared with, with the data locked */
  template <typename Fill>
  void ask(const Fill& fill)
  {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      fill(query_);
      has_answer_ = false;
    }
    send();
  }

  /** Sends the query again, with another stamp. */
  void repeat(ros::Time stamp)
  {
    query_.header.stamp = stamp;
    send();
  }

  /** Forgets the response to the last query: the next one counts. */
  void forgetAnswer()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    has_answer_ = false;
  }

  bool hasAnswer() const
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return has_answer_;
  }

  /** Waits for the response. @return true when it is there */
  bool waitForAnswer(double seconds)
  {
    const Clock::time_point deadline =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    if (receiveFromLine(deadline))
      return true;
    if (line_.isConnected())
      return false;
    const LoopCosts::Scope transport(costs_, LoopPhase::kTransport);
    std::unique_lock<std::mutex> lock(mutex_);
    return answered_.wait_until(lock, deadline, [this] { return has_answer_; });
  }

  /** Receives the responses that have arrived over the line. @return true when one of them is the answer */
  bool receiveArrived() { return receiveFromLine(Clock::now()); }

  /** Number of nodes that receive queries from the topic. */
  std::uint32_t subscribers() const { return publisher_.getNumSubscribers(); }

  /** Lock of what Accept changes. */
  std::unique_lock<std::mutex> access() const { return std::unique_lock<std::mutex>(mutex_); }

private:
  void send()
  {
    // Only the calling thread writes the query, so it may read it without the lock.
    toFrame(query_, frame_);
    const LoopCosts::Scope transport(costs_, LoopPhase::kTransport);
    const bool is_sent = line_.send(frame_);
    // The node of the line subscribes too. Its queries over both ways would be answered twice.
    if (!is_sent || publisher_.getNumSubscribers() > 1)
      publisher_.publish(query_);
  }

  /** Message for the next response; reuses the memory of the last one, since long lists are slow to allocate. */
  boost::shared_ptr<Response> emptyMessage()
  {
    if (!message_ || !message_.unique())
      message_ = boost::make_shared<Response>();
    return message_;
  }

  void receive(Response& message)
  {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      has_answer_ = accept_(message, has_answer_) || has_answer_;
      if (!has_answer_)
        return;
    }
    answered_.notify_one();
  }

  bool receiveFromLine(Clock::time_point deadline)
  {
    const LoopCosts::Scope transport(costs_, LoopPhase::kTransport);
    while (const FrameStream* const stream = line_.receive(deadline))
    {
      const LoopCosts::Scope conversion(costs_, LoopPhase::kConversion);
      try
      {
        fromFrame(stream->frame(), stream->frameSize(), line_message_);
        receive(line_message_);
      }
      catch (const std::exception& error)
      {
        IgnoredMessages::ofProcess().add(response_topic_, error.what());
      }
      if (hasAnswer())
        return true;
    }
    return false;
  }

  ros::NodeHandle node_;
  std::string response_topic_;
  LoopCosts& costs_;
  LineClient line_;
  Accept accept_;
  std::vector<std::uint8_t> frame_;  ///< query as sent over the line
  Response line_message_;            ///< buffer of the calling thread
  DirectCallbackQueue queue_;
  ros::Publisher publisher_;
  mutable std::mutex mutex_;
  std::condition_variable answered_;
  Query query_;                          ///< as published
  bool has_answer_ = false;              ///< guarded
  boost::shared_ptr<Response> message_;  ///< buffer of the receiving thread
  ros::Subscriber subscriber_;           ///< last, so that it ends before the members that its callback uses
};

}  // namespace endovascular_sim::nodes
