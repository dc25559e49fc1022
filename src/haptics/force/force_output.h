#pragma once

namespace endovascular_sim::haptics
{

/** Force and torque at the hand. */
struct HandForce
{
  double force = 0.0;   ///< positive against insertion [N]
  double torque = 0.0;  ///< positive against rotation [N·m]
};

/** What a device may be asked to render. */
struct ForceLimits
{
  double force = 5.0;         ///< [N]
  double torque = 0.05;       ///< [N·m]
  double force_rate = 500.0;  ///< [N/s]
  double torque_rate = 5.0;   ///< [N·m/s]
  double ramp_time = 15e-3;   ///< from any force to zero after release() [s]
};

/** The last station before the hand: clamps, limits the rate of change, and takes the force away on any doubt.
 *  What it gives is always finite and within the limits. */
class ForceOutput
{
public:
  explicit ForceOutput(const ForceLimits& limits = {}) : limits_(limits) {}

  /** A new force from the simulation.
   *  @return false when it is not finite: the output is released */
  bool command(const HandForce& wanted, double now);
  /** Begins the linear ramp to zero; does nothing while one is under way. */
  void release(double now);
  /** Zero at once. */
  void cut();
  /** Moves on to time @p now [s] and returns the force there. */
  HandForce advance(double now);

  const HandForce& value() const { return value_; }
  bool isZero() const { return value_.force == 0.0 && value_.torque == 0.0; }
  /** The value still differs from where it is going. */
  bool isMoving() const { return value_.force != target_.force || value_.torque != target_.torque; }

private:
  ForceLimits limits_;
  HandForce value_;
  HandForce target_;
  double time_ = 0.0;  ///< of value_ [s]
  bool releasing_ = true;
  HandForce release_from_;
  double release_time_ = 0.0;
};

}  // namespace endovascular_sim::haptics
