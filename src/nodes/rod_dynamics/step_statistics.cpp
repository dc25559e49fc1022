#include "nodes/rod_dynamics/step_statistics.h"

#include <algorithm>
#include <array>
#include <string>

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kLate = 1e-3;  ///< delay behind its deadline above which a step counts as late [s]

}  // namespace

void StepStatistics::addStep(const simulation::Simulation& simulation, const StepTimes& times, bool is_faded)
{
  const double seconds = std::chrono::duration<double>(times.end - times.begin).count();
  const double delay = std::chrono::duration<double>(times.end - times.slot_end).count();
  ++steps_;
  late_steps_ += delay > kLate;
  worst_delay_ = std::max(worst_delay_.load(), delay);
  rejected_steps_ += !simulation.report().solved;
  is_rejecting_ = !simulation.report().solved || is_faded;
  if (!simulation.contactSet().stale)  // a stale set gives an estimate only
    worst_penetration_ = std::max(worst_penetration_.load(), simulation.surfacePenetration());
  longest_step_ = std::max(longest_step_.load(), seconds);
  total_step_ = total_step_ + seconds;
  const std::lock_guard<PriorityInheritanceMutex> lock(phase_mutex_);
  for (std::size_t k = 0; k < kLoopPhases; ++k)
    processor_times_[k] += times.phases.processor[k];
  lateness_.add(times.phases, times.woken_late, delay > kLate, delay > 0.0);
}

/** Adds the processor time of a step by phase, and the late steps by their cause. */
void StepStatistics::diagnosePhases(diagnostic_updater::DiagnosticStatusWrapper& status) const
{
  std::array<double, kLoopPhases> sums{};
  std::array<std::uint64_t, LateSteps::kCauses> late{};
  {
    const std::lock_guard<PriorityInheritanceMutex> lock(phase_mutex_);
    sums = processor_times_;
    for (std::size_t k = 0; k < late.size(); ++k)
      late[k] = lateness_.count(k);
  }
  const double steps = std::max(1.0, static_cast<double>(steps_));
  for (std::size_t k = 0; k < sums.size(); ++k)
    status.add(std::string("processor time, ") + kLoopPhaseNames[k] + " [us]", 1e6 * sums[k] / steps);
  for (std::size_t k = 0; k < late.size(); ++k)
    status.add(std::string("late steps, ") + LateSteps::nameOf(k), late[k]);
}

void StepStatistics::setHeld(const std::string& reason, bool is_fault)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  pauses_ += is_fault && !reason.empty();
  held_ = reason;
  is_fault_ = is_fault;
}

void StepStatistics::setContactSets(std::uint64_t stale, std::uint64_t rejected)
{
  stale_sets_ = stale;
  rejected_sets_ = rejected;
}

void StepStatistics::diagnose(const SchedulingGrant& grant, diagnostic_updater::DiagnosticStatusWrapper& status) const
{
  const std::uint64_t steps = steps_;
  const std::uint64_t late = late_steps_;
  const double on_time = steps > 0 ? 100.0 * (1.0 - static_cast<double>(late) / static_cast<double>(steps)) : 100.0;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!held_.empty())
    status.summary(is_fault_ ? diagnostic_msgs::DiagnosticStatus::ERROR : diagnostic_msgs::DiagnosticStatus::WARN,
                   "paused: " + held_);
  else if (is_rejecting_)
    status.summary(diagnostic_msgs::DiagnosticStatus::ERROR,
                   "the solver rejects steps: the wire is held, without force");
  else if (!grant.isInForce())
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "scheduling: " + grant.describe());
  else if (const std::size_t others = grant.other_sessions(); others > 0)
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN,
                   std::to_string(others) + " other session(s) use the same processor: steps may be late");
  else if (on_time < 99.0)
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN,
                   "more than 1 % of the steps are late; the values \"late steps\" name the causes");
  else
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, "running");
  status.add("scheduling", grant.describe());
  status.add("other sessions on the processor", grant.other_sessions());
  status.add("steps", steps);
  status.add("deadline misses", late);
  status.add("on time [%]", on_time);
  status.add("step time, mean [us]", steps > 0 ? 1e6 * total_step_ / static_cast<double>(steps) : 0.0);
  status.add("step time, longest [us]", 1e6 * longest_step_);
  diagnosePhases(status);
  status.add("stale contact sets", stale_sets_.load());
  status.add("rejected contact sets (late, duplicate or invalid)", rejected_sets_.load());
  status.add("pauses", pauses_.load());
  status.add("rejected steps", rejected_steps_.load());
  status.add("largest delay behind the deadline [s]", worst_delay_.load());
  status.add("discarded backlogs", discarded_backlogs_.load());
  status.add("worst penetration [m]", worst_penetration_.load());
}

}  // namespace endovascular_sim::nodes
