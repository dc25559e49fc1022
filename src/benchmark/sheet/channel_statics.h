#pragma once

#include <vector>

#include "benchmark/reference/equilibrium.h"
#include "vessel/anatomy/tube.h"

namespace endovascular_sim::benchmark
{

/** Straight wire in a plane channel, held by the introducer at the channel's start: one of uniform stiffness, or one
 * that ends in a softer tail, as a catheter over a guidewire that reaches further. */
struct ChannelProblem
{
  std::vector<vessel::TubePiece> pieces;  ///< plane_angle 0 or π
  double clearance = 0.0;                 ///< largest distance between the axes of wire and channel [m]
  double bending_stiffness = 0.0;         ///< EI [N·m²]
  double friction = 0.0;                  ///< Coulomb coefficient
  double inserted_length = 0.0;           ///< without the tail [m]
  double tail_length = 0.0;               ///< [m]
  double tail_stiffness = 0.0;            ///< EI of the tail [N·m²]
  double tail_clearance = 0.0;            ///< clearance of the tail [m]
  double tip_force = 0.0;                 ///< force on the tip against its direction of advance [N]
  double advance = 1.0;                   ///< 1: the wire is pushed; −1: pulled; 0: at rest, without friction
};

/** Wire in a channel at rest, or sliding slowly. */
struct ChannelState
{
  double hand_force = 0.0;           ///< axial force of the wire on the introducer [N]
  double energy = 0.0;               ///< of bending, and of the walls [J]
  std::vector<double> arc_length;    ///< of every node from the introducer [m]
  std::vector<double> normal_force;  ///< of the wall on every node [N]

  /** Sum of the magnitudes of all normal forces [N]. */
  double totalNormalForce() const { return normalForceBefore(arc_length.back() + 1.0); }
  /** The same up to an arc length [m]. */
  double normalForceBefore(double end) const;
};

/** Brute-force statics of a wire in a channel: Newton's method on the energy of a fine discrete rod between stiff walls
 *  (EquilibriumSolver), Coulomb friction as dead loads μ N against the motion, iterated until they agree with the
 *  normal forces. No mesh, no time steps and no contact detection are shared with the simulation.
 *  @throws std::runtime_error without an equilibrium */
ChannelState channelStatics(const ChannelProblem& problem);

/** Quasi-static force that advances a sleeve of the given stiffness over its tail, which rests and slides in it without
 *  friction: the derivative of the least energy by the inserted length, plus the friction of the channel on the sleeve
 *  to first order, μ ΣN. With advance −1, the force of its withdrawal [N]. */
double trackingForce(const ChannelProblem& problem);

/** Torque and turn of a wire that is turned slowly at its proximal end, in a channel that it slides in all around. */
struct ChannelTorque
{
  double torque = 0.0;  ///< at the introducer [N·m]
  double lag = 0.0;     ///< turn of the introducer less that of the tip [rad]
};

/** The friction of a turning wire is circumferential: μ N/√(1 + μ²) at a contact that without friction has N.
 *  @param state of the wire at rest, without friction
 *  @param radius of the wire [m]
 *  @param torsional_stiffness GJ [N·m²] */
ChannelTorque channelTorque(const ChannelState& state, double friction, double radius, double torsional_stiffness);

}  // namespace endovascular_sim::benchmark
