#pragma once

#include <cstdint>
#include <mutex>

#include <ros/ros.h>

#include "endovascular_sim/SessionProgress.h"
#include "nodes/runtime/direct_callback_queue.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{

/** Progress of the session node's recording, for a simulation that must not outrun it. Without a session node there is
 *  nothing to wait for. */
class RecorderProgress
{
public:
  explicit RecorderProgress(const ros::NodeHandle& node)
  {
    subscriber_ = subscribeGuarded<SessionProgress>(
        node, names::kSessionProgress, 10, [this](const SessionProgress& message) { receive(message); }, &queue_);
  }

  bool isPresent() const { return subscriber_.getNumPublishers() > 0; }

  /** True if the recorder has taken over all but the last @p most of @p steps steps. */
  bool isWithin(std::uint64_t steps, std::uint64_t most) const
  {
    if (!isPresent())
      return true;
    const std::lock_guard<std::mutex> lock(mutex_);
    return steps < newest_.steps + most;
  }

  /** True if the recorder has begun a run. */
  bool hasBegun(std::uint32_t run) const
  {
    if (!isPresent())
      return true;
    const std::lock_guard<std::mutex> lock(mutex_);
    return newest_.run >= run;
  }

private:
  void receive(const SessionProgress& message)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    newest_ = message;
  }

  DirectCallbackQueue queue_;
  mutable std::mutex mutex_;
  SessionProgress newest_;      ///< guarded
  ros::Subscriber subscriber_;  ///< last, so that it ends before the members that its callback uses
};

}  // namespace endovascular_sim::nodes
