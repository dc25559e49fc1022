#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include <ros/ros.h>

#include "endovascular_sim/FlowAnswer.h"
#include "endovascular_sim/FlowRequest.h"
#include "flow/coupling/flow_source.h"
#include "nodes/rod_dynamics/control/loop_costs.h"
#include "nodes/rod_dynamics/query_channel.h"

namespace endovascular_sim::nodes
{

/** Node `hemodynamics` as the source of the steps of the flow, behind a local line or its topics (QueryChannel).
 *
 *  A request is sent without waiting; its answer is needed a step of the flow later. The number of the request is in
 *  its answer, so that none is taken for that of another request, e.g. of the run before a reset. */
class RemoteFlowSource : public flow::FlowSource
{
public:
  /** @param costs of the loop that requests; must outlive this object */
  RemoteFlowSource(const ros::NodeHandle& node, LoopCosts& costs);

  void request(const flow::FlowRequest& request) override;

  /** Waits up to 10 s. May be called again before the next request.
   *  @throws InputError without an answer */
  flow::FlowAnswer answer() override;

  /** Lengths of the lists in an answer. */
  struct Sizes
  {
    std::size_t nodes = 0, cells = 0, lines = 0, lesions = 0, contrast_cells = 0;
  };

  /** Sets the lengths that every answer must have; before the first request. */
  void setSizes(const Sizes& sizes) { sizes_ = sizes; }

  /** Sets the stamp of the next requests. */
  void setStamp(ros::Time stamp) { stamp_ = stamp; }

  /** True when the last request has been answered, and before the first one. Receives what has arrived. */
  bool isReady();

  /** Waits for the answer to the last request. A long wait repeats the request, which a restarted node has missed.
   *  @return true when it is there */
  bool waitForAnswer(double seconds);

  /** Waits for the node. @return false when ROS shut down */
  bool waitForNode() const;

  std::uint64_t rejectedAnswers() const { return rejected_; }  ///< number of late, duplicate and invalid answers

private:
  using Clock = std::chrono::steady_clock;

  bool accept(FlowAnswer& message, bool is_answered);
  void repeatWhenDue();

  LoopCosts& costs_;
  ros::Time stamp_, asked_stamp_;
  std::uint64_t asked_ = 0;  ///< number of the last request; 0 before the first one. Guarded by the channel
  flow::FlowAnswer answer_;  ///< guarded by the channel
  Clock::time_point sent_;   ///< time of the last request, or of its last repetition
  Sizes sizes_;
  std::uint64_t asked_step_ = 0;  ///< of the last request; guarded by the channel
  std::size_t asked_probes_ = 0;  ///< the same
  std::atomic<std::uint64_t> rejected_{0};
  QueryChannel<FlowRequest, FlowAnswer> channel_;  ///< last, so that it ends before the members that it changes
};

}  // namespace endovascular_sim::nodes
