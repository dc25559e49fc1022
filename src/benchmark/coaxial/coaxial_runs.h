#pragma once

#include <vector>

#include "rod/kkt/kkt_stepper.h"

namespace endovascular_sim::benchmark
{

/** Wire that slides around a bend of 30 mm radius under a force on its tip, with straight parts on both sides. */
struct CoaxialCase
{
  double angle = 1.5707963;          ///< of the bend [rad]
  double friction = 0.2;             ///< Coulomb coefficient [1]
  double tip_tension = 0.375;        ///< force that pulls the tip outward [N]
  bool pull = true;                  ///< the hand withdraws the wire, or advances it
  double bending_stiffness = 40e-6;  ///< of the wire [N·m²]
  double clearance = 4.445e-4;       ///< radius of the bore less that of the wire [m]
  double edge = 1e-3;                ///< distance of the nodes [m]
  double tip_across = 0.0;           ///< with the angle 0: force on the tip across, beyond the vessel's end [N]
};

/** Force of the hand on the sliding wire, in the direction of its motion, in a catheter that follows the bend [N]. */
double forceInCatheter(const CoaxialCase& at);

/** The same in a rigid smooth tube of the bore of the catheter: one wire, whose contacts are those of the wall [N]. */
double forceInTube(const CoaxialCase& at);

/** Wire in a catheter along a bend, both moved by their handles. */
class CoaxialPair
{
public:
  explicit CoaxialPair(const CoaxialCase& at);
  ~CoaxialPair();

  /** Moves the wire at constant speed.
   *  @param travel insertion, negative for withdrawal [m]
   *  @return mean force on the hand, positive when it pushes back [N] */
  double move(double travel);

  const rod::State& state() const { return state_; }

  /** Work of both hands since the start [J]. */
  double work() const { return work_; }

private:
  class Wall;

  void step();

  std::unique_ptr<Wall> wall_;
  std::unique_ptr<rod::KktStepper> stepper_;
  rod::State state_;
  rod::StepInput input_;
  PhaseTimer timer_;
  double work_ = 0.0;
};

}  // namespace endovascular_sim::benchmark
