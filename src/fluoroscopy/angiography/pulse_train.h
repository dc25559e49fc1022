#pragma once

#include <cstdint>

namespace endovascular_sim::fluoroscopy
{

/** Pulses of an X-ray system at simulated times: pulse k is at the first step at or after k/rate.
 *
 *  Steps are counted from the beginning of the scene, so that pulses are the same in every program, and after a saved
 * state. Step s ends at the time s·Δt; pulse 0 shows the state before the first step. With more pulses than steps,
 * several pulses fall on one step, which shows the newest of them. */
class PulseTrain
{
public:
  /** @param rate of the pulses [Hz], positive
   *  @param time_step of the simulation [s], positive */
  PulseTrain(double rate, double time_step) : steps_per_pulse_(1.0 / (rate * time_step)) {}

  /** Number of steps after which a pulse is given. */
  std::uint64_t stepOf(std::uint64_t pulse) const;

  /** Newest pulse at or before a number of steps. */
  std::uint64_t newestAt(std::uint64_t steps) const;

  /** First pulse at or after a number of steps. */
  std::uint64_t firstFrom(std::uint64_t steps) const { return newestAt(steps) + (isPulse(steps) ? 0 : 1); }

  /** True if a pulse is given after this number of steps. */
  bool isPulse(std::uint64_t steps) const { return stepOf(newestAt(steps)) == steps; }

private:
  double steps_per_pulse_;
};

}  // namespace endovascular_sim::fluoroscopy
