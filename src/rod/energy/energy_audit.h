#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "rod/boundary/boundary_conditions.h"
#include "rod/contact/wall_friction.h"
#include "rod/energy/energy_balance.h"
#include "rod/energy/potential_energy.h"
#include "rod/stepping/stepper.h"

namespace endovascular_sim::rod
{

/** Slide of a layer's surface and of the masses over a node in a step [m]; see LayerSlides. */
struct NodeSlide
{
  Eigen::Vector3d surface = Eigen::Vector3d::Zero();
  Eigen::Vector3d mass = Eigen::Vector3d::Zero();
  Eigen::Vector3d mass_gained = Eigen::Vector3d::Zero();
};

/** Forces of an accepted solution that resist the motion of the nodes. */
struct ResistingForces
{
  std::vector<Eigen::Vector3d> friction;  ///< of the wall along the surface, on every node [N]
  std::vector<double> damping;            ///< per displacement of the masses [N/m]
  std::vector<double> drag;               ///< per displacement of the surface [N/m]

  void reset(std::size_t nodes);
};

/** Potential energies of a state whose nodes all have a position. @param from first node whose weight counts */
using PotentialFunction = std::function<PotentialEnergy(const State& state, int from)>;

/** Part of a step that a scheme has accepted. */
struct AuditedPart
{
  const State& before;
  const State& after;
  const std::vector<Eigen::Vector3d>& begin;  ///< positions at the beginning, those of entering nodes extrapolated [m]
  const StepInput& input;
  double dt;  ///< [s]
  const Discretisation& rod;
  const Boundary& boundary;
  const BoundaryConditions& conditions;
  const PotentialFunction& potential;
  const ResistingForces& forces;
  const std::vector<NodeSlide>& slides;          ///< empty: every mass moves with its node
  const std::vector<TwistFriction>& about_axis;  ///< friction of the wall in the last relaxation of the twist
  const std::vector<double>& surface_begin;      ///< angle of the surface at every node before the part [rad]
  const std::vector<double>& surface_angle;      ///< after the part [rad]
  const std::vector<double>& frame_turns;        ///< of the Bishop frame of every edge [rad]; empty: neglected
  double wall_energy;                            ///< springs of contacts after the part [J]
  double layer_friction_push;                    ///< work of the friction between layers along the wire [J]
  double layer_friction_turn;                    ///< about the wire [J]
  double insertion_work;                         ///< of the hands, on the potentials at fixed nodes [J]
};

/** Energy audit of a wire: the balance of every accepted part of its steps (docs/PHYSICS.md, "Energy audit").
 *
 *  Forces are those at the end of a part, as backward Euler uses them. A potential U(x, θ, ℓ) of positions, twist
 * angles and insertions is audited by its derivative along the motion, which is evaluated by central differences. The
 * work of its force minus its change is the dissipation of the integration. Its change by the insertion at fixed nodes
 * is a configurational force, which is right only if the force on the hand contains it. */
class EnergyAudit
{
public:
  /** Sum over all steps so far. */
  const EnergyBalance& balance() const { return sum_; }

  /** Discards the parts of a step that has failed, or adds them. A wire that was stopped loses its kinetic energy.
   *  @param kinetic energy at the beginning of the step [J] */
  void endStep(bool solved, double kinetic);

  void addPart(const AuditedPart& part);

  /** Adds work of the introducer's valve, which is part of the force on the hand. */
  void addValve(double push, double turn);

  /** Sets the least radii of the surface, those of balloons; see Stepper::setContactRadii. */
  void setContactRadii(const std::vector<double>& radii) { least_radius_ = radii; }

private:
  void addLoads(const AuditedPart& part);
  void addHands(const AuditedPart& part);
  void addMotion(const AuditedPart& part);
  void addPotentials(const AuditedPart& part);
  void addChangeOfNodes(const PotentialEnergy& first, const PotentialEnergy& final);
  void addFriction(const AuditedPart& part);
  void addTensions(const AuditedPart& part);
  void addContact(const AuditedPart& part);
  void addResidual(const AuditedPart& part, double by_free_nodes);

  EnergyBalance sum_;
  EnergyBalance pending_;                ///< parts of the present step
  PotentialEnergy last_, pending_last_;  ///< after the last part [J]
  bool started_ = false, pending_started_ = false;
  double turn_balance_ = 0.0;  ///< torques on the twist times their angles in the present part [J]
  double wall_energy_ = 0.0, pending_wall_energy_ = 0.0;
  std::vector<double> least_radius_;         ///< of balloons at every node [m]; empty: none
  std::vector<double> radius_, own_radius_;  ///< of the surface, with and without balloons, after a part [m]
  std::vector<double> pending_radius_, pending_own_radius_;
};

/** A state with positions and angles of the nodes that are not simulated, which lie straight outside the introducer. */
State completed(const State& state, const Boundary& boundary, const BoundaryConditions& conditions);

/** Kinetic energy of the simulated nodes [J]. */
double kineticEnergy(const Discretisation& rod, const State& state);

}  // namespace endovascular_sim::rod
