#pragma once

#include "rod/model/state.h"

namespace endovascular_sim::rod
{

/** Coulomb friction, with sticking, of the introducer's valve on the wire.
 *
 *  The wire's surface moves along and about its axis. Up to a displacement of kPreSliding the friction is proportional
 * to it; beyond, the surface slides and the friction is constant, against the direction of sliding. Turning a wire that
 * is pushed therefore reduces the axial friction. The law is independent of speed. */
class HemostaticValve
{
public:
  static constexpr double kPreSliding = 1e-6;  ///< [m]

  /** @param friction [N]; 0: no valve */
  explicit HemostaticValve(double friction) : friction_(friction) {}

  /** True where there is a valve. */
  bool present() const { return friction_ != 0.0; }

  /** Subtracts the valve from the force and torque on the hand, which are then the wire's own. */
  void release(State& state) const;

  /** Advances the valve's friction by a motion of the wire, and adds it to the force and torque on the hand.
   *  @param travel of the wire into the vessel [m]
   *  @param turn of the wire about its axis [rad]
   *  @param radius of the wire in the valve [m] */
  void drag(State& state, double travel, double turn, double radius) const;

private:
  double friction_;
};

}  // namespace endovascular_sim::rod
