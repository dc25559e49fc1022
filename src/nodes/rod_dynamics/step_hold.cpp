#include "nodes/rod_dynamics/step_hold.h"

#include <algorithm>

#include "nodes/rod_dynamics/control/step_scheduler.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kIdlePeriod = 10e-3;  ///< interval of zero forces [s]

double seconds(std::chrono::steady_clock::duration time)
{
  return std::chrono::duration<double>(time).count();
}

}  // namespace

void StepHold::begin(double patience)
{
  if (is_active_)
    return;
  is_active_ = true;
  since_ = next_ = Clock::now() + StepScheduler::period(patience);
}

void StepHold::announce(const std::string& reason, bool is_fault)
{
  if (reason == reason_)
    return;
  reason_ = reason;
  statistics_.setHeld(reason, is_fault);
  simulation_.setState(reason.empty() ? drive::OperatingState::kEnabled : drive::OperatingState::kPaused, reason);
  const auto step = static_cast<unsigned long>(simulation_.simulation().steps());
  if (reason.empty())
    ROS_WARN("continuing at step %lu after %.3f s", step, seconds(Clock::now() - since_));
  else
    ROS_WARN("paused at step %lu: %s", step, reason.c_str());
}

void StepHold::publish()
{
  const Clock::time_point now = Clock::now();
  if (now < next_)
    return;
  const double share = std::max(0.0, 1.0 - seconds(now - since_) / HandForceRenderer::kRampTime);
  simulation_.publishHeld(share);
  is_faded_ = true;
  next_ = now + StepScheduler::period(share > 0.0 ? simulation_.scene().solver.time_step : kIdlePeriod);
}

void StepHold::release()
{
  is_active_ = false;
  if (is_faded_)
    simulation_.fadeForcesIn();
  is_faded_ = false;
  announce("", false);
}

double StepHold::untilNext() const
{
  return std::clamp(seconds(next_ - Clock::now()), 0.0, kIdlePeriod);
}

}  // namespace endovascular_sim::nodes
