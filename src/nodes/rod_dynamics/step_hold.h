#pragma once

#include <chrono>
#include <string>

#include "nodes/rod_dynamics/graph_simulation.h"
#include "nodes/rod_dynamics/step_statistics.h"

namespace endovascular_sim::nodes
{

/** Time in which no step is taken: it publishes the last commands, and the rendered forces ramp to zero. */
class StepHold
{
public:
  using Clock = std::chrono::steady_clock;

  /** @param simulation, statistics must outlive this object */
  StepHold(GraphSimulation& simulation, StepStatistics& statistics) : simulation_(simulation), statistics_(statistics)
  {
  }

  bool isActive() const { return is_active_; }

  /** Begins a hold, unless there is one.
   *  @param patience time in which forces stay [s] */
  void begin(double patience);

  /** Announces the reason of the hold when it is another one than before.
   *  @param reason empty while the simulation waits for calls
   *  @param is_fault true for a reason that another node causes */
  void announce(const std::string& reason, bool is_fault);

  /** Publishes the commands of the last step when they are due. */
  void publish();

  /** Ends the hold before the next step. */
  void release();

  /** Time until publish() is due, at most 10 ms [s]. */
  double untilNext() const;

private:
  GraphSimulation& simulation_;
  StepStatistics& statistics_;
  bool is_active_ = false;
  bool is_faded_ = false;    ///< true when forces have been faded since the last step
  std::string reason_;       ///< announced reason; empty while waiting for calls
  Clock::time_point since_;  ///< begin of the forces' ramp to zero
  Clock::time_point next_;   ///< time of the next publication
};

}  // namespace endovascular_sim::nodes
