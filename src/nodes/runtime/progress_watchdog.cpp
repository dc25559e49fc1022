#include "nodes/runtime/progress_watchdog.h"

#include <chrono>
#include <ctime>
#include <utility>

#include "nodes/runtime/real_time.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr auto kPeriod = std::chrono::milliseconds(250);

/** Processor time of the process [s]. */
double processorTime()
{
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

ProgressWatchdog::ProgressWatchdog(const std::atomic<unsigned long>& progress, int priority,
                                   std::function<void()> give_up, StallCriterion criterion)
  : progress_(progress),
    give_up_(std::move(give_up)),
    criterion_(criterion),
    thread_([this, priority] { watch(priority); })
{
}

ProgressWatchdog::~ProgressWatchdog()
{
  stop_ = true;
  thread_.join();
}

void ProgressWatchdog::watch(int priority)
{
  makeThreadRealTime(priority);
  auto last = std::chrono::steady_clock::now();
  double used = processorTime();
  while (!stop_)
  {
    sleepUntil(std::chrono::steady_clock::now() + kPeriod);
    const auto now = std::chrono::steady_clock::now();
    const double total = processorTime();
    const double elapsed = std::chrono::duration<double>(now - last).count();
    const double share = elapsed > 0.0 ? (total - used) / elapsed : 0.0;
    last = now;
    used = total;
    if (!criterion_.observe(progress_, share))
      continue;
    give_up_();
    return;
  }
}

std::unique_ptr<ProgressWatchdog> superviseScheduling(SchedulingGrant& grant,
                                                      const std::atomic<unsigned long>& progress, int priority,
                                                      const std::function<void()>& withdraw, StallCriterion criterion)
{
  const auto withdrawn = std::make_shared<std::atomic<bool>>(false);
  grant.withdrawn = withdrawn;
  return std::make_unique<ProgressWatchdog>(
      progress, priority,
      [withdrawn, withdraw]
      {
        withdraw();
        *withdrawn = true;
      },
      criterion);
}

}  // namespace endovascular_sim::nodes
