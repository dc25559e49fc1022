#include <algorithm>

#include "nodes/rod_dynamics/rod_dynamics_node.h"
#include "nodes/runtime/node_program.h"

// Times of RodDynamicsNode without a step.

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kIdlePeriod = 10e-3;       ///< interval of zero forces while no step is taken [s]
constexpr double kBetweenCalls = 10e-3;     ///< time between two calls of simulation/step in which forces stay [s]
constexpr std::uint64_t kMostAhead = 5000;  ///< lead before the recorder: half of its queue [steps]
constexpr double kBriefWait = 1.0;          ///< wait for the recorder that is no pause [s]
constexpr auto kPausedByClient = "paused by simulation/pause; continues with simulation/resume";
constexpr auto kContactLost = "no response of the contact node or of the vessel server behind it";
constexpr auto kRecorderBehind = "the recorder lags behind; continues when it has caught up";

double seconds(std::chrono::steady_clock::duration time)
{
  return std::chrono::duration<double>(time).count();
}

}  // namespace

/** Reason for which no step can be taken now; empty without one. */
std::string RodDynamicsNode::obstacle()
{
  if (is_paused_)
    return kPausedByClient;
  if (isContactMissing())
    return kContactLost;
  return isRecorderBehind() ? kRecorderBehind : "";
}

bool RodDynamicsNode::isContactLost() const
{
  const RemoteContactSource* contacts = simulation_.contacts();
  if (contacts == nullptr || !contacts->silent())
    return false;
  return pace_ != Pace::kRealTime || seconds(Clock::now() - contacts->silentSince()) > pause_after_;
}

/** Queries a lost contact node again. @return false when it is not lost, or has responded */
bool RodDynamicsNode::isContactMissing()
{
  if (!isContactLost())
  {
    is_listening_ = false;
    return false;
  }
  if (!is_listening_)
    simulation_.contacts()->startListening();
  is_listening_ = true;
  return !simulation_.contacts()->probe();
}

/** Outside of real time nothing but the recorder limits the rate of the steps: its queues must not overflow. A brief
 *  lag is waited for. */
bool RodDynamicsNode::isRecorderBehind()
{
  if (pace_ == Pace::kRealTime)
    return false;
  const Clock::time_point end = Clock::now() + StepScheduler::period(is_held_ ? 0.0 : kBriefWait);
  while (!recorder_.isWithin(simulation_.simulation().steps(), kMostAhead))
  {
    if (Clock::now() >= end || isOver())
      return true;
    countProgress();
    sleepUntil(Clock::now() + StepScheduler::period(1e-3));
  }
  return false;
}

/** Takes no step for a short time, in which calls of the services are executed.
 *  @param reason empty while the simulation waits for a call of simulation/step */
void RodDynamicsNode::hold(const std::string& reason)
{
  beginHold(reason.empty() ? kBetweenCalls : 0.0);
  announceHold(reason);
  publishHeld();
  const double wait = seconds(next_held_ - Clock::now());
  services_->serve(std::clamp(wait, 0.0, kIdlePeriod));
}

/** @param patience time in which forces stay [s] */
void RodDynamicsNode::beginHold(double patience)
{
  if (is_held_)
    return;
  is_held_ = true;
  held_since_ = next_held_ = Clock::now() + StepScheduler::period(patience);
}

void RodDynamicsNode::announceHold(const std::string& reason)
{
  if (reason == held_reason_)
    return;
  held_reason_ = reason;
  statistics_.setHeld(reason, reason == kContactLost);
  simulation_.setState(reason.empty() ? drive::OperatingState::kEnabled : drive::OperatingState::kPaused, reason);
  const auto step = static_cast<unsigned long>(simulation_.simulation().steps());
  if (reason.empty())
    ROS_WARN("continuing at step %lu after %.3f s", step, seconds(Clock::now() - held_since_));
  else
    ROS_WARN("paused at step %lu: %s", step, reason.c_str());
}

/** Publishes the commands of the last step when it is due; the rendered forces ramp to zero from the begin of the hold.
 */
void RodDynamicsNode::publishHeld()
{
  const Clock::time_point now = Clock::now();
  if (now < next_held_)
    return;
  const double share = std::max(0.0, 1.0 - seconds(now - held_since_) / HandForceRenderer::kRampTime);
  simulation_.publishHeld(share);
  is_faded_ = true;
  next_held_ = now + StepScheduler::period(share > 0.0 ? simulation_.scene().solver.time_step : kIdlePeriod);
}

/** Ends a hold before the next step. */
void RodDynamicsNode::release()
{
  is_held_ = false;
  if (is_faded_)
    simulation_.fadeForcesIn();
  is_faded_ = false;
  announceHold("");
}

}  // namespace endovascular_sim::nodes
