#pragma once

#include "common/phase_timer.h"
#include "contact/contract/contact_set.h"
#include "rod/model/discretisation.h"
#include "rod/model/state.h"
#include "rod/stepping/stepper.h"
#include "rod/twist/twist.h"

namespace endovascular_sim::rod
{

/** What a boundary means for the nodes of a wire: the part that all schemes share. A view of both, to be made where it
 *  is used. */
class BoundaryConditions
{
public:
  BoundaryConditions(const Discretisation& rod, const Boundary& boundary) : rod_(rod), boundary_(boundary) {}

  /** Place of a node along the boundary's direction while the wire is straight, 0 at its origin [m]. */
  double bodyPosition(int node, double inserted_length) const
  {
    return boundary_.introducer ? inserted_length - (rod_.length() - rod_.position[node]) : rod_.position[node];
  }

  /** True for nodes that the boundary moves. */
  bool isPrescribed(int node, const State& state) const;

  /** A straight wire at rest along the boundary's direction. */
  State initialState(double inserted_length, double rotation) const;

  /** Moves the prescribed nodes to where they are at the end of a step of @p dt [s], and lets nodes be born or leave at
   *  the introducer. */
  void placePrescribedNodes(State& state, double inserted_length, double dt) const;

  /** Lateral stiffness of the introducer's guide on a node [N/m]; 0 outside it. */
  double guideStiffness(int node, const State& state) const;

  /** Brings state.twist_angle and state.hand_torque to rest for the present centreline.
   *  @return true when the twist acts on the centreline */
  bool relaxTwist(QuasiStaticTwist& twist, State& state, double tip_torque, PhaseTimer& timer) const;

  /** The nodes of the query: those beyond the introducer's mouth. */
  void describe(const State& state, contact::Query& query) const;

  /** Adds to a described query, as its first point, the place where the wire leaves the introducer's mouth, so that the
   *  edge that is half inside meets the wall too.
   *  @return the parameter of that place on its edge; 0 when nothing had to be added */
  double describeMouth(const State& state, contact::Query& query) const;

  /** Where and how the twist is held, the far end left free. */
  TwistBoundary twistBoundary(const State& state, double tip_torque) const;

  /** With an introducer, the last but one of the prescribed nodes: two of them hold position and direction. */
  int firstSimulatedNode(double inserted_length) const;

private:
  const Discretisation& rod_;
  const Boundary& boundary_;
};

/** Elastic energies of a state.
 *  @param twist as last solved for this state; null when it does not act */
Energy elasticEnergy(const Discretisation& rod, const State& state, const QuasiStaticTwist* twist);

}  // namespace endovascular_sim::rod
