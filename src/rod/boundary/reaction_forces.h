#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Core>

#include "rod/linear/banded_ldlt.h"
#include "rod/model/state.h"
#include "rod/stepping/stepper.h"

namespace endovascular_sim::rod
{

/** Remainder rhs − A x of three rows of a banded system. For the equations of a held node it is the force of the wire
 * on the hold, in the system's units.
 *  @param matrix before its rows were prescribed or factorised
 *  @param rhs of the three rows, likewise
 *  @param row first of the three rows */
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

/** Updates the forces of the wire on the holds of its ends, and the axial force on the hand.
 *
 *  They are computed from the equations of the held nodes. An edge's multiplier is no substitute: in a bent edge it
 *  contains a part of the bending force.
 *  @param is_held (int node) → bool
 *  @param force_on_hold (int node) → Eigen::Vector3d, force of the wire on the hold of a node [N] */
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
