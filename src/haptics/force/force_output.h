#pragma once

namespace endovascular_sim::haptics
{

/** Force and torque rendered to the user's hand. */
struct HandForce
{
  double force = 0.0;   ///< positive against insertion [N]
  double torque = 0.0;  ///< positive against rotation [N·m]
};

/** Limits of the force and torque sent to a device. */
struct ForceLimits
{
  double force = 5.0;         ///< largest force [N]
  double torque = 0.05;       ///< largest torque [N·m]
  double force_rate = 500.0;  ///< largest rate of change of the force [N/s]
  double torque_rate = 5.0;   ///< largest rate of change of the torque [N·m/s]
  double ramp_time = 15e-3;   ///< duration of the ramp from any force to zero after release() [s]
  double return_time = 0.25;  ///< duration of the return from zero to the largest force after a release [s]
};

/** Safety stage before the device: clamps the force, limits its rate of change, and ramps it to zero on release.
 *
 *  After a release the force returns from zero at the rate `force / return_time` until it meets its target; then the
 *  ordinary rate applies. The output is always finite and within the limits. */
class ForceOutput
{
public:
  explicit ForceOutput(const ForceLimits& limits = {}) : limits_(limits) {}

  /** Sets the target force.
   *  @return false if the force is not finite; the output is then released */
  bool command(const HandForce& wanted, double now);
  /** Starts the linear ramp to zero; has no effect during a ramp. */
  void release(double now);
  /** Sets the force to zero immediately. */
  void cut();
  /** Advances to time @p now [s].
   *  @return force at that time */
  HandForce advance(double now);

  const HandForce& value() const { return value_; }
  bool isZero() const { return value_.force == 0.0 && value_.torque == 0.0; }
  /** True while the value differs from its target. */
  bool isMoving() const { return value_.force != target_.force || value_.torque != target_.torque; }

private:
  ForceLimits limits_;
  HandForce value_;
  HandForce target_;
  double time_ = 0.0;  ///< time of value_ [s]
  bool releasing_ = true;
  bool returning_ = true;  ///< true after a release, until the value meets its target
  HandForce release_from_;
  double release_time_ = 0.0;
};

}  // namespace endovascular_sim::haptics
