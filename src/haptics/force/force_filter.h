#pragma once

#include "haptics/force/force_output.h"

namespace endovascular_sim::haptics
{

/** Low pass of second order (Butterworth) on the force for the hand: y'' = ω²(u − y) − √2 ω y', by implicit Euler at
 * the times at which forces come, so that it is stable at any rate.
 *
 *  It delays slow forces by √2/ω, 2.3 ms at 100 Hz, and a delay takes from the stiffness that a device renders stably.
 *  A cut-off of 0 passes every force on unchanged. */
class ForceFilter
{
public:
  /** @param cutoff −3 dB [Hz]; 0: none */
  explicit ForceFilter(double cutoff = 0.0) : cutoff_(cutoff) {}

  HandForce next(const HandForce& force, double now);
  /** The next force passes as it is. */
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
