#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>

#include <ros/ros.h>

#include "endovascular_sim/SessionProgress.h"
#include "nodes/runtime/direct_callback_queue.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{

/** Progress of the session node's recording, for a simulation that must not outrun it. Without a session node, and
 * after its regular end, there is nothing to wait for. One that is lost is expected again for kPatience. */
class RecorderProgress
{
public:
  static constexpr std::chrono::seconds kPatience{8};

  explicit RecorderProgress(const ros::NodeHandle& node)
  {
    subscriber_ = subscribeGuarded<SessionProgress>(
        node, names::kSessionProgress, 10, [this](const SessionProgress& message) { receive(message); }, &queue_);
  }

  bool isPresent() const
  {
    if (subscriber_.getNumPublishers() == 0)
      return false;
    const std::lock_guard<std::mutex> lock(mutex_);
    return newest_.ended == 0;
  }

  /** True if the recorder has taken over all but the last @p most of @p steps steps. */
  bool isWithin(std::uint64_t steps, std::uint64_t most)
  {
    if (!isPresent() && !isExpected())
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
  using Clock = std::chrono::steady_clock;

  void receive(const SessionProgress& message)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    newest_ = message;
    is_lost_ = false;
  }

  /** Reports whether a recorder that was lost may come back. @pre it is not present */
  bool isExpected()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (newest_.run == 0 || newest_.ended != 0)
      return false;
    if (!is_lost_)
      lost_since_ = Clock::now();
    is_lost_ = true;
    return Clock::now() - lost_since_ < kPatience;
  }

  DirectCallbackQueue queue_;
  mutable std::mutex mutex_;
  SessionProgress newest_;  ///< guarded, as the next two
  bool is_lost_ = false;    ///< true: the recorder is absent, without a regular end
  Clock::time_point lost_since_;
  ros::Subscriber subscriber_;  ///< last, so that it ends before the members that its callback uses
};

}  // namespace endovascular_sim::nodes
