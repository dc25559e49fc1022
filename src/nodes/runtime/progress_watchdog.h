#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <thread>

#include "nodes/runtime/real_time.h"

namespace endovascular_sim::nodes
{

/** Criterion for a real-time process that occupies its processor without progress. Independent of clocks: it counts
 *  observations, so that a process that was stopped and continued is not mistaken for one that loops. */
class StallCriterion
{
public:
  static constexpr int kObservations = 8;    ///< consecutive observations without progress
  static constexpr double kBusyShare = 0.8;  ///< processor time over elapsed time above which a process is busy [1]

  /** @param busy_share share above which a process is busy [1] */
  explicit StallCriterion(double busy_share = kBusyShare) : busy_share_(busy_share) {}

  /** Adds an observation.
   *  @param progress counter of the loop
   *  @param busy_share processor time of the process over the elapsed time since the last observation [1]
   *  @return true when real-time scheduling must be given up */
  bool observe(unsigned long progress, double busy_share)
  {
    const bool stalled = progress == last_progress_ && busy_share >= busy_share_;
    last_progress_ = progress;
    stalled_ = stalled ? stalled_ + 1 : 0;
    return stalled_ >= kObservations;
  }

private:
  double busy_share_;
  unsigned long last_progress_ = 0;
  int stalled_ = 0;
};

/** Thread above the priority of a real-time process that gives up its real-time scheduling when its loop makes no
 *  progress: such a loop would block every other process of its processor. */
class ProgressWatchdog
{
public:
  /** @param progress counter of the loop
   *  @param priority of the watchdog's thread
   *  @param give_up called once, in the watchdog's thread */
  ProgressWatchdog(const std::atomic<unsigned long>& progress, int priority, std::function<void()> give_up,
                   StallCriterion criterion = StallCriterion());
  ~ProgressWatchdog();
  ProgressWatchdog(const ProgressWatchdog&) = delete;
  ProgressWatchdog& operator=(const ProgressWatchdog&) = delete;

private:
  void watch(int priority);

  const std::atomic<unsigned long>& progress_;
  std::function<void()> give_up_;
  StallCriterion criterion_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/** Starts the watchdog of a granted scheduling, which marks the grant and its copies as withdrawn.
 *  @param progress counter of the loop
 *  @param priority of the watchdog's thread
 *  @param withdraw restores ordinary scheduling; called at most once, in the watchdog's thread */
std::unique_ptr<ProgressWatchdog> superviseScheduling(SchedulingGrant& grant,
                                                      const std::atomic<unsigned long>& progress, int priority,
                                                      const std::function<void()>& withdraw,
                                                      StallCriterion criterion = StallCriterion());

}  // namespace endovascular_sim::nodes
