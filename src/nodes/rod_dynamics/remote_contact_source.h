#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>

#include <ros/ros.h>

#include "contact/contract/contact_set.h"
#include "endovascular_sim/RodState.h"
#include "nodes/conversions/contact_set_serializer.h"
#include "nodes/rod_dynamics/response_timeout.h"
#include "nodes/runtime/direct_callback_queue.h"

namespace endovascular_sim::nodes
{

/** Contact node behind its topics, as the solver's source of contact sets.
 *
 *  Lock-step: a query is published, and the calling thread waits for the response, the set with the same step, sub-step
 *  and pass. Without a response within the timeout the set stays stale (degraded mode). */
class RemoteContactSource : public contact::ContactSource
{
public:
  /** @param timeout longest wait for one response [s] */
  RemoteContactSource(const ros::NodeHandle& node, double timeout);

  void detect(const contact::Query& query, contact::ContactSet& set) override;
  void freeDistances(const contact::Query& query, double wanted, contact::ContactSet& set) override;

  /** Starts the observation of probe(): earlier responses do not count. */
  void startListening() { heard_ = false; }

  /** Publishes the last query again, without waiting.
   *  @return true when a response has arrived since the last call */
  bool probe();

  /** Waits for the first response of the contact node. @return false when ROS shut down */
  bool waitForNode(const contact::Query& query);

  bool silent() const { return timeout_.silent(); }  ///< true without a response to the last query
  std::chrono::steady_clock::time_point silentSince() const { return silent_since_; }
  std::uint64_t staleSets() const { return stale_sets_; }        ///< number of queries without a response
  std::uint64_t rejectedSets() const { return rejected_sets_; }  ///< number of late, duplicate and invalid sets

private:
  boost::shared_ptr<StampedContactSet> emptyMessage();
  void receive(const boost::shared_ptr<StampedContactSet>& message);
  bool waitForResponse(double seconds);
  bool waitForAnswer(double seconds);
  void ask(const contact::Query& query, double wanted_free_distance);
  void request(const contact::Query& query, double wanted_free_distance, contact::ContactSet& set);
  void publish();

  ros::NodeHandle node_;
  DirectCallbackQueue queue_;
  ros::Publisher publisher_;
  ResponseTimeout timeout_;
  mutable std::mutex mutex_;
  std::condition_variable answered_;
  RodState query_;                                ///< as published
  contact::Query asked_;                          ///< guarded: the receiving thread validates responses against it
  contact::ContactSet answer_;                    ///< guarded
  bool has_answer_ = false;                       ///< guarded
  boost::shared_ptr<StampedContactSet> message_;  ///< buffer of the receiving thread
  std::atomic<bool> heard_{false};
  std::chrono::steady_clock::time_point silent_since_;
  std::uint64_t stale_sets_ = 0;
  std::atomic<std::uint64_t> rejected_sets_{0};
  ros::Subscriber subscriber_;  ///< last, so that it ends before the members that its callback uses
};

}  // namespace endovascular_sim::nodes
