#pragma once

namespace endovascular_sim::simulation
{

/** Slew-rate limiter of the rendered force after missing contact sets. One object per force component.
 *
 *  During steps with a stale contact set the last force is held. Afterwards the output approaches the simulation's
 * force with a rate of at most kRate times the largest force so far, 1 % of this peak per millisecond. The limit ends
 * when the output has met the simulation's force and kSettlingTime has passed. The limit is needed because the first
 * fresh set reveals the errors of the stale one, and the simulation corrects them with a peak of force. Without a
 * missing set the force passes unchanged. */
class ForceFaultLimiter
{
public:
  static constexpr double kRate = 10.0;           ///< largest slew rate, relative to the peak [1/s]
  static constexpr double kSettlingTime = 50e-3;  ///< duration of the limit after the last stale set [s]

  /** @param least_peak lower bound of the peak [N or N·m] */
  explicit ForceFaultLimiter(double least_peak) : peak_(least_peak) {}

  /** Filters the force of one step.
   *  @param force force of the simulation after the step [N or N·m]
   *  @param stale true when the step used a stale contact set
   *  @param dt duration of the step [s]
   *  @return force to render [N or N·m] */
  double filter(double force, bool stale, double dt);

  /** Sets the output to zero; the next forces are approached from there. */
  void reset();

private:
  double peak_;
  double output_ = 0.0;
  double remaining_ = 0.0;  ///< time until the limit may end [s]
};

}  // namespace endovascular_sim::simulation
