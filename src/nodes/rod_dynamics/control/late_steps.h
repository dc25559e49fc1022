#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "nodes/rod_dynamics/control/loop_costs.h"

namespace endovascular_sim::nodes
{

/** Late steps of a loop by their cause.
 *
 *  A step is late because of its own time, or because of a backlog that earlier steps left. The cause is therefore
 *  searched in all steps since the loop was last in time: the phase with the largest excess over its budget. A budget
 * is the mean of the phase, reduced where the means of all phases together leave no reserve. Two further causes: the
 *  thread did not run, and the loop woke too late. */
class LateSteps
{
public:
  static constexpr std::size_t kNotRun = kLoopPhases;     ///< the thread waited for a processor
  static constexpr std::size_t kWoken = kLoopPhases + 1;  ///< the begin of the step was late without a backlog
  static constexpr std::size_t kCauses = kLoopPhases + 2;

  /** @param slot duration of a step in real time [s] */
  explicit LateSteps(double slot) : slot_(slot) {}

  /** Adds a step.
   *  @param woken_late delay of its begin that no step before caused [s]
   *  @param is_late true: counted
   *  @param has_backlog false: the step ended within its slot */
  void add(const LoopTimes& times, double woken_late, bool is_late, bool has_backlog);

  std::uint64_t count(std::size_t cause) const { return counts_[cause]; }
  static const char* nameOf(std::size_t cause);

private:
  double slot_;  ///< [s]
  std::uint64_t steps_ = 0;
  std::array<double, kLoopPhases> sums_{};  ///< wall time of each phase in all steps [s]
  std::array<double, kCauses> excess_{};    ///< since the loop was last in time [s]
  std::array<std::uint64_t, kCauses> counts_{};
};

}  // namespace endovascular_sim::nodes
