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

/** The contact node behind its topics, as the solver's source of contact sets.
 *
 *  Lock-step: a query is published and its answer, the set with the same step, sub-step and pass, is waited for in the
 *  calling thread. An answer that does not come within the patience leaves the set stale (degraded mode). */
class RemoteContactSource : public contact::ContactSource
{
public:
  /** @param patience how long one answer is waited for [s] */
  RemoteContactSource(ros::NodeHandle node, double patience);

  void detect(const contact::Query& query, contact::ContactSet& set) override;
  void freeDistances(const contact::Query& query, double wanted, contact::ContactSet& set) override;

  /** Forgets what was heard so far: from now on probe() tells of new answers. */
  void startListening() { heard_ = false; }

  /** Asks the last query again without waiting.
   *  @return whether the node has answered it since the last call */
  bool probe();

  /** Waits until the contact node answers for the first time, or ROS ends. @return false when ROS ended */
  bool waitForNode(const contact::Query& query);

  bool silent() const { return patience_.silent(); }  ///< the last query was not answered
  std::chrono::steady_clock::time_point silentSince() const { return silent_since_; }
  std::uint64_t staleSets() const { return stale_sets_; }  ///< queries that went unanswered so far
  std::uint64_t oddSets() const { return odd_sets_; }      ///< answers that fit no question: late, duplicate or wrong

private:
  boost::shared_ptr<StampedContactSet> emptyMessage();
  void receive(const boost::shared_ptr<StampedContactSet>& message);
  bool waitForAnswer(double seconds);
  void ask(const contact::Query& query, double wanted_free_distance);
  void request(const contact::Query& query, double wanted_free_distance, contact::ContactSet& set);
  void publish();

  ros::NodeHandle node_;
  DirectCallbackQueue queue_;
  ros::Publisher publisher_;
  ResponseTimeout patience_;
  mutable std::mutex mutex_;
  std::condition_variable answered_;
  RodState query_;                                ///< as it is published
  contact::Query asked_;                          ///< guarded: the receiving thread compares answers with it
  contact::ContactSet answer_;                    ///< guarded
  bool has_answer_ = false;                       ///< guarded
  boost::shared_ptr<StampedContactSet> message_;  ///< of the receiving thread
  std::atomic<bool> heard_{false};
  std::chrono::steady_clock::time_point silent_since_;
  std::uint64_t stale_sets_ = 0;
  std::atomic<std::uint64_t> odd_sets_{0};
  ros::Subscriber subscriber_;  ///< last, so that it ends before what its callback uses
};

}  // namespace endovascular_sim::nodes
