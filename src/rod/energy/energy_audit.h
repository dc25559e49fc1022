#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/energy/accepted_part.h"
#include "rod/energy/energy_balance.h"
#include "rod/stepping/solution_observer.h"

namespace endovascular_sim::rod
{

/** Energy audit of a wire: the balance of every accepted part of its steps (docs/PHYSICS.md, "Energy audit").
 *
 *  Forces are those at the end of a part, as backward Euler uses them. A potential U(x, θ, ℓ) of positions, twist
 * angles and insertions is audited by its derivative along the motion, which is evaluated by central differences. The
 * work of its force minus its change is the dissipation of the integration. Its change by the insertion at fixed nodes
 * is a configurational force, which is right only if the force on the hand contains it. */
class EnergyAudit : public SolutionObserver
{
public:
  /** Sum over all steps so far. */
  const EnergyBalance& balance() const { return sums_.sum; }

  void setContactRadii(const std::vector<double>& radii) override { sums_.least_radius = radii; }
  void beginStep(const Discretisation& rod, const State& state) override;
  void addPart(const AcceptedPart& part) override;
  /** A wire that was stopped loses its kinetic energy. */
  void endStep(bool solved) override;
  void addValve(double push, double turn) override;
  void addMovedWall(double work) override;
  void keep() override { kept_ = sums_; }
  void revert() override { sums_ = kept_; }

private:
  void addLoads(const AcceptedPart& part);
  void addHands(const AcceptedPart& part);
  void addStream(const AcceptedPart& part);
  void addMotion(const AcceptedPart& part);
  void addPotentials(const AcceptedPart& part);
  void addChangeOfNodes(const PotentialEnergy& first, const PotentialEnergy& final);
  void addFriction(const AcceptedPart& part);
  void addTensions(const AcceptedPart& part);
  void addContact(const AcceptedPart& part);
  void addWallMotion(const AcceptedPart& part);
  void addResidual(const AcceptedPart& part, double by_free_nodes);

  /** Energies and radii after the last part. */
  struct End
  {
    bool started = false;            ///< false before the first part
    PotentialEnergy potential;       ///< [J]
    double wall_energy = 0.0;        ///< [J]
    std::vector<double> radius;      ///< of the surface [m]
    std::vector<double> own_radius;  ///< without balloons [m]
  };

  /** All that was observed. */
  struct Sums
  {
    EnergyBalance sum;
    EnergyBalance pending;             ///< parts of the present step
    End last, pending_last;            ///< after the last step, and the last part of the present one
    double kinetic = 0.0;              ///< at the beginning of the present step [J]
    std::vector<double> least_radius;  ///< of balloons at every node [m]; empty: none
  };

  Sums sums_, kept_;
  double turn_balance_ = 0.0;  ///< torques on the twist times their angles in the present part [J]
};

/** A state with positions and angles of the nodes that are not simulated, which lie straight outside the introducer. */
State completed(const State& state, const Boundary& boundary, const BoundaryConditions& conditions);

/** Kinetic energy of the simulated nodes [J]. */
double kineticEnergy(const Discretisation& rod, const State& state);

}  // namespace endovascular_sim::rod
