#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Core>

#include "rod/linear/banded_ldlt.h"
#include "rod/model/state.h"
#include "rod/stepping/stepper.h"

namespace endovascular_sim::rod
{

/** What a solution leaves of three lines of a banded system, rhs − A x: of a held node's own equation, the force of the
 *  wire on its hold, in the system's units.
 *  @param matrix before its rows were prescribed or factorised
 *  @param rhs of the three lines, likewise
 *  @param row first of the three lines */
template <int Bandwidth, int Period>
Eigen::Vector3d remainder(const BandedLdlt<Bandwidth, Period>& matrix, Eigen::Vector3d rhs,
                          const std::vector<double>& solution, int row)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const int line = row + axis;
    for (int k = std::max(0, line - Bandwidth); k <= std::min(matrix.size() - 1, line + Bandwidth); ++k)
      rhs[axis] -= matrix.at(std::max(line, k), std::min(line, k)) * solution[k];
  }
  return rhs;
}

/** Sets the forces of the wire on what holds its ends, and the axial one on the hand.
 *
 *  The hand's force is taken from the equations of the held nodes, not from an edge's multiplier: in a bent edge that
 *  one holds a part of the bending too.
 *  @param is_held (int node) → bool
 *  @param force_on_hold (int node) → Eigen::Vector3d, of a held node [N] */
template <typename IsHeld, typename ForceOnHold>
void updateEndForces(State& state, const Boundary& boundary, IsHeld is_held, ForceOnHold force_on_hold)
{
  const int nodes = static_cast<int>(state.position.size());
  const int distal = boundary.distal == EndHold::kClamped ? 2 : boundary.distal == EndHold::kPinned ? 1 : 0;
  state.proximal_force.setZero();
  state.distal_force.setZero();
  for (int i = state.first_node; i < nodes; ++i)
    if (is_held(i))
      (i + distal < nodes ? state.proximal_force : state.distal_force) += force_on_hold(i);
  state.hand_force = -boundary.direction.dot(state.proximal_force);
}

}  // namespace endovascular_sim::rod
