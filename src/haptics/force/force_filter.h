#pragma once

#include "haptics/force/force_output.h"

namespace endovascular_sim::haptics
{

/** Second-order Butterworth low-pass filter of the rendered force: y'' = ω²(u − y) − √2 ω y'.
 *
 *  Implicit Euler integrates it at the arrival times of the forces and is stable at any rate. The group delay at low
 *  frequency is √2/ω, i.e. 2.3 ms at 100 Hz. Delay reduces the stiffness that a device renders stably. With a cutoff
 *  frequency of 0 the filter is off and forces pass unchanged. */
class ForceFilter
{
public:
  /** @param cutoff −3 dB frequency [Hz]; 0: filter off */
  explicit ForceFilter(double cutoff = 0.0) : cutoff_(cutoff) {}

  /** Filters the force that arrives at time @p now [s]. */
  HandForce next(const HandForce& force, double now);
  /** Restarts the filter: the next force passes unchanged. */
  void reset() { started_ = false; }

private:
  struct State
  {
    double value = 0.0;
    double rate = 0.0;
    double next(double input, double omega, double dt);
  };

  double cutoff_;
  State force_;
  State torque_;
  double time_ = 0.0;
  bool started_ = false;
};

}  // namespace endovascular_sim::haptics
