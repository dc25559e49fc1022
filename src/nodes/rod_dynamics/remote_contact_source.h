#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <vector>

#include <ros/ros.h>

#include "contact/contract/contact_set.h"
#include "endovascular_sim/RodState.h"
#include "nodes/conversions/contact_set_serializer.h"
#include "nodes/rod_dynamics/control/loop_costs.h"
#include "nodes/rod_dynamics/response_timeout.h"
#include "nodes/runtime/direct_callback_queue.h"
#include "nodes/runtime/line/local_line.h"

namespace endovascular_sim::nodes
{

/** Contact node as the solver's source of contact sets, behind a local line or its topics.
 *
 *  Lock-step: a query is sent, and the calling thread waits for the response, the set with the same step, sub-step and
 *  pass. Without a response within the timeout the set stays stale (degraded mode). A contact node of the same machine
 *  offers a local line, which carries the messages of the topics at a fraction of their cost. With it, rod/state is
 *  published for further subscribers only, and sets from the topic are ignored. */
class RemoteContactSource : public contact::ContactSource
{
public:
  /** @param timeout longest wait for one response [s]
   *  @param costs of the loop that queries; must outlive this object */
  RemoteContactSource(const ros::NodeHandle& node, double timeout, LoopCosts& costs);

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
  void receive(StampedContactSet& message);
  bool receiveFromLine(std::chrono::steady_clock::time_point deadline);
  bool waitForResponse(double seconds);
  bool waitForAnswer(double seconds);
  void ask(const contact::Query& query, double wanted_free_distance);
  void request(const contact::Query& query, double wanted_free_distance, contact::ContactSet& set);
  void publish();
  bool hasAnswer() const;

  ros::NodeHandle node_;
  LoopCosts& costs_;
  LineClient line_;
  std::vector<std::uint8_t> frame_;  ///< query as sent over the line
  StampedContactSet line_message_;   ///< buffer of the calling thread
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
