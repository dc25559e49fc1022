#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

#include <ros/ros.h>

#include "contact/contract/contact_set.h"
#include "endovascular_sim/RodState.h"
#include "nodes/conversions/contact_set_serializer.h"
#include "nodes/rod_dynamics/control/loop_costs.h"
#include "nodes/rod_dynamics/query_channel.h"
#include "nodes/rod_dynamics/response_timeout.h"

namespace endovascular_sim::nodes
{

/** Contact node as the solver's source of contact sets, behind a local line or its topics (QueryChannel).
 *
 *  Lock-step: a query is sent, and the calling thread waits for the response, the set with the same step, sub-step and
 *  pass. Without a response within the timeout the set stays stale (degraded mode). */
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
  bool accept(StampedContactSet& message, bool is_answered);
  bool waitForResponse(double seconds);
  void ask(const contact::Query& query, double wanted_free_distance);
  void request(const contact::Query& query, double wanted_free_distance, contact::ContactSet& set);

  LoopCosts& costs_;
  ResponseTimeout timeout_;
  contact::Query asked_;        ///< guarded by the channel: responses are validated against it in its thread
  contact::ContactSet answer_;  ///< guarded by the channel
  std::atomic<bool> heard_{false};
  std::chrono::steady_clock::time_point silent_since_;
  std::uint64_t stale_sets_ = 0;
  std::atomic<std::uint64_t> rejected_sets_{0};
  QueryChannel<RodState, StampedContactSet> channel_;  ///< last, so that it ends before the members that it changes
};

}  // namespace endovascular_sim::nodes
