#pragma once

namespace endovascular_sim::simulation
{

/** Carries the force that the hand is told over contact sets that failed to come.
 *
 *  Without a fresh set the force is held; afterwards it goes back to the simulation's, which at first answers the old
 *  set's errors with a blow. On both ways it changes per second by at most ten times the largest force so far, which is
 *  1 % of the peak per millisecond, until it has met the simulation's force and `kSettlingTime` has passed. While no
 *  set has failed it passes the force on unchanged. One object per component of force. */
class ForceFaultLimiter
{
public:
  static constexpr double kRate = 10.0;           ///< of the peak [1/s]
  static constexpr double kSettlingTime = 50e-3;  ///< after the last old set [s]

  /** @param least peak that is assumed before the force has one [N or N·m] */
  explicit ForceFaultLimiter(double least) : peak_(least) {}

  /** @param force of the simulation after a step of @p dt [s]
   *  @param blind the step used an old contact set
   *  @return the force to tell */
  double told(double force, bool blind, double dt);

  /** The force was taken away: it comes back from zero. */
  void drop();

  bool isPassing() const { return left_ <= 0.0; }  ///< the simulation's force is told as it is

private:
  double peak_;
  double told_ = 0.0;
  double left_ = 0.0;  ///< until a meeting ends the bridge [s]
};

}  // namespace endovascular_sim::simulation
