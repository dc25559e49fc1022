#pragma once

#include "common/archive.h"

namespace endovascular_sim::flow
{

/** Transducer at the end of a catheter that is filled with fluid. It follows the pressure p at the tip as
 *
 *      ÿ + 2ζω ẏ + ω² (y − p) = 0   (Gardner 1981),
 *
 *  so that a line with little damping overshoots, and one with much of it loses the pulse. The trapezoidal rule takes p
 *  as linear between two steps; it is stable for any step. */
class PressureLine
{
public:
  /** @param frequency natural frequency ω/2π [Hz]
   *  @param damping ζ [1]
   *  @param pressure at the beginning, at rest [Pa]
   *  @throws std::invalid_argument for values that are not positive */
  PressureLine(double frequency, double damping, double pressure);

  /** @param pressure p at the end of the step [Pa]
   *  @param time_step [s]
   *  @return y at the end of the step [Pa] */
  double step(double pressure, double time_step);

  double reading() const { return reading_; }  ///< y [Pa]

  void archive(Archive& archive) { archive(reading_, rate_, pressure_); }

private:
  double omega_, damping_;
  double reading_;     // y [Pa]
  double rate_ = 0.0;  // ẏ [Pa/s]
  double pressure_;    // p of the step before [Pa]
};

}  // namespace endovascular_sim::flow
