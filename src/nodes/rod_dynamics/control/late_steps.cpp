#include "nodes/rod_dynamics/control/late_steps.h"

#include <algorithm>
#include <numeric>

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kUsableShare = 0.8;  ///< of a slot, for the budgets of all phases [1]

}  // namespace

const char* LateSteps::nameOf(std::size_t cause)
{
  return cause == kNotRun ? "not running" : cause == kWoken ? "woken late" : kLoopPhaseNames[cause];
}

void LateSteps::add(const LoopTimes& times, double woken_late, bool is_late, bool has_backlog)
{
  ++steps_;
  for (std::size_t k = 0; k < kLoopPhases; ++k)
    sums_[k] += times.wall[k];
  const double mean = std::accumulate(sums_.begin(), sums_.end(), 0.0) / static_cast<double>(steps_);
  const double reserve = mean > 0.0 ? std::min(1.0, kUsableShare * slot_ / mean) : 1.0;
  for (std::size_t k = 0; k < kLoopPhases; ++k)
  {
    // The transport waits for the contact node by design.
    const bool waits = k == static_cast<std::size_t>(LoopPhase::kTransport);
    const double not_run = waits ? 0.0 : std::max(0.0, times.wall[k] - times.processor[k]);
    excess_[k] += std::max(0.0, times.wall[k] - not_run - reserve * sums_[k] / static_cast<double>(steps_));
    excess_[kNotRun] += not_run;
  }
  excess_[kWoken] += woken_late;
  if (is_late)
    ++counts_[static_cast<std::size_t>(std::max_element(excess_.begin(), excess_.end()) - excess_.begin())];
  if (!has_backlog)
    excess_.fill(0.0);
}

}  // namespace endovascular_sim::nodes
