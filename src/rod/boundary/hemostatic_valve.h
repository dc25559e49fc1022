#pragma once

#include "rod/model/state.h"

namespace endovascular_sim::rod
{

/** Dry friction of the introducer's valve on the wire that the hand drives through it: Coulomb's, which sticks.
 *
 *  The wire's surface is dragged along and about its axis; up to kPreSliding the valve pulls in proportion, beyond it
 *  slides: the pull is then `friction`, against the direction of sliding, so that turning a wire that is pushed takes
 *  its force away from pushing. Depends on the way only, not on the time that it takes. */
class HemostaticValve
{
public:
  static constexpr double kPreSliding = 1e-6;  ///< [m]

  /** @param friction [N]; 0: no valve */
  explicit HemostaticValve(double friction) : friction_(friction) {}

  /** True where there is a valve. */
  bool present() const { return friction_ != 0.0; }

  /** Takes the valve out of the hand's force and torque, which are then the wire's own. */
  void release(State& state) const;

  /** Drags the valve's friction along, and adds it to the hand's force and torque.
   *  @param travel of the wire into the vessel [m]
   *  @param turn [rad]
   *  @param radius of the wire in the valve [m] */
  void drag(State& state, double travel, double turn, double radius) const;

private:
  double friction_;
};

}  // namespace endovascular_sim::rod
