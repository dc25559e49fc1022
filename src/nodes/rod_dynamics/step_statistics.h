#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

#include <diagnostic_updater/diagnostic_updater.h>

#include "nodes/rod_dynamics/control/late_steps.h"
#include "nodes/runtime/priority_inheritance_mutex.h"
#include "nodes/runtime/real_time.h"
#include "simulation/simulation.h"

namespace endovascular_sim::nodes
{

/** Counters of the simulation loop for /diagnostics: written by the loop, read by another thread. */
class StepStatistics
{
public:
  using Clock = std::chrono::steady_clock;

  /** Times of one step. */
  struct StepTimes
  {
    Clock::time_point begin, end;
    Clock::time_point slot_end;  ///< deadline of the step
    double woken_late = 0.0;     ///< delay of its begin that no step before caused [s]
    LoopTimes phases;
  };

  /** @param slot duration of a step in real time [s] */
  explicit StepStatistics(double slot) : lateness_(slot) {}

  /** Counts a step.
   *  @param is_faded true while rendered forces are faded after rejected steps */
  void addStep(const simulation::Simulation& simulation, const StepTimes& times, bool is_faded);

  /** Sets the totals of the contact source. */
  void setContactSets(std::uint64_t stale, std::uint64_t rejected);

  /** Sets the reason for which no step is taken at present; empty without one.
   *  @param is_fault false for a wish of a client */
  void setHeld(const std::string& reason, bool is_fault);
  void addDiscardedBacklog() { ++discarded_backlogs_; }

  void diagnose(const SchedulingGrant& grant, diagnostic_updater::DiagnosticStatusWrapper& status) const;

private:
  void diagnosePhases(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  std::atomic<std::uint64_t> steps_{0};
  std::atomic<std::uint64_t> late_steps_{0};
  std::atomic<std::uint64_t> stale_sets_{0};
  std::atomic<std::uint64_t> rejected_sets_{0};
  std::atomic<std::uint64_t> pauses_{0};
  std::atomic<std::uint64_t> rejected_steps_{0};
  std::atomic<std::uint64_t> discarded_backlogs_{0};
  std::atomic<bool> is_rejecting_{false};
  std::atomic<double> worst_penetration_{0.0};         ///< [m]
  std::atomic<double> longest_step_{0.0};              ///< [s]
  std::atomic<double> worst_delay_{0.0};               ///< largest delay of a step's end behind its deadline [s]
  std::atomic<double> total_step_{0.0};                ///< sum of all step times [s]
  mutable PriorityInheritanceMutex phase_mutex_;       ///< guards the next two
  std::array<double, kLoopPhases> processor_times_{};  ///< sums over all steps [s]
  LateSteps lateness_;
  mutable std::mutex mutex_;  ///< guards the next two
  std::string held_;          ///< reason for which no step is taken; empty without one
  bool is_fault_ = false;     ///< of another node
};

}  // namespace endovascular_sim::nodes
