#pragma once

#include "common/phase_timer.h"
#include "contact/contract/contact_set.h"
#include "rod/model/discretisation.h"
#include "rod/model/state.h"
#include "rod/stepping/stepper.h"
#include "rod/twist/twist.h"

namespace endovascular_sim::rod
{

/** Nodes that a clamp holds, which depends on the unknowns of a scheme. */
enum class ClampedNodes
{
  kEdge,  ///< both nodes of the end edge: the clamp acts at its middle (schemes whose only unknowns are positions)
  kNode,  ///< the end node alone: the scheme's own unknowns hold the direction there
};

/** Half-open range of nodes that a step has moved with the introducer. */
struct PlacedNodes
{
  int begin = 0;
  int born = 0;  ///< end of the nodes that were not simulated before
  int end = 0;
};

/** Boundary conditions of a wire, node by node. All schemes share them. A view of the rod and of its boundary. */
class BoundaryConditions
{
public:
  BoundaryConditions(const Discretisation& rod, const Boundary& boundary, ClampedNodes clamped = ClampedNodes::kEdge)
    : rod_(rod), boundary_(boundary), clamped_(clamped)
  {
  }

  /** Coordinate of a node along the boundary's direction while the wire is straight, 0 at its origin [m]. */
  double bodyPosition(int node, double inserted_length) const
  {
    return boundary_.introducer ? inserted_length - (rod_.length() - rod_.position[node]) : rod_.position[node];
  }

  /** True for nodes that the boundary moves. */
  bool isPrescribed(int node, const State& state) const;

  /** True for prescribed nodes of the distal end. */
  bool isDistalHeld(int node) const
  {
    const int last = rod_.nodes() - 1;
    return boundary_.distal != EndHold::kFree && (node == last || (node == last - 1 && clampsEdge(boundary_.distal)));
  }

  /** First node that the proximal end does not hold. */
  int firstFreeNode(const State& state) const;

  /** A straight wire at rest along the boundary's direction. */
  State initialState(double inserted_length, double rotation) const;

  /** Moves the nodes that the proximal end prescribes to their positions at the end of a step of @p dt [s]; nodes
   *  enter or leave the simulated part at the introducer. */
  PlacedNodes placePrescribedNodes(State& state, double inserted_length, double dt) const;

  /** Moves a held distal end to its position at the end of a step of @p dt [s]. A clamp moves the middle of its edge
   *  and turns the edge about it. */
  void placeDistalEnd(State& state, const EndMotion& motion, double dt) const;

  /** Computes the quasi-static state.twist_angle and state.hand_torque for the present centreline.
   *  @return true when the twist acts on the centreline */
  bool relaxTwist(QuasiStaticTwist& twist, State& state, double tip_torque, PhaseTimer& timer) const;

  /** Sets the nodes of a contact query: those beyond the introducer's mouth. */
  void describe(const State& state, contact::Query& query) const;

  /** Adds to a described query, as its first point, the point at which the wire leaves the introducer's mouth, so that
   *  the part of its edge that is in the vessel is queried too.
   *  @return the parameter of that point on its edge; 0 when nothing had to be added */
  double describeMouth(const State& state, contact::Query& query) const;

  /** Boundary of the twist, the distal end free. */
  TwistBoundary twistBoundary(const State& state, double tip_torque) const;

  /** Boundary of the twist with the inputs of a step and the hold of the distal end. */
  TwistBoundary twistBoundary(const State& state, const StepInput& input) const;

  /** First simulated node. With an introducer, the last but one of the prescribed nodes: two of them hold position and
   *  direction. */
  int firstSimulatedNode(double inserted_length) const;

private:
  bool clampsEdge(EndHold hold) const { return hold == EndHold::kClamped && clamped_ == ClampedNodes::kEdge; }

  const Discretisation& rod_;
  const Boundary& boundary_;
  ClampedNodes clamped_;
};

/** Elastic energies of a state.
 *  @param twist as last solved for this state; null when it does not act */
Energy elasticEnergy(const Discretisation& rod, const State& state, const QuasiStaticTwist* twist);

/** Insertion at which the tip of an instrument is outside the introducer and its guide [m]. */
double outsideInsertion(const Discretisation& rod, double guide_length);

/** Largest insertion of an instrument, at which the introducer's guide is still filled [m].
 *  @param length of the instrument [m] */
double maxInsertion(double length, const Discretisation& rod, double guide_length);

}  // namespace endovascular_sim::rod
