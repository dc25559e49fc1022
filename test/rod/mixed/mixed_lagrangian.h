#pragma once

#include "rod/mixed/mixed_rod.h"
#include "rod/model/turning_angle.h"

namespace endovascular_sim::rod
{

/** Turning angle term M·Φ of one node; 0 where the end may turn. */
inline double turningTerm(const MixedRod& rod, const State& state, int node)
{
  const int last = rod.nodes() - 1;
  if ((node == state.first_node && rod.proximal().hold != EndHold::kClamped) ||
      (node == last && rod.distal().hold != EndHold::kClamped))
    return 0.0;
  const Eigen::Vector3d before = node == state.first_node
                                     ? rod.proximal().tangent
                                     : Eigen::Vector3d(state.position[node] - state.position[node - 1]);
  const Eigen::Vector3d after =
      node == last ? rod.distal().tangent : Eigen::Vector3d(state.position[node + 1] - state.position[node]);
  return state.moment[node].dot(TurningAngle(before, after).value);
}

/** Lagrangian L of MixedRod's class comment, of the simulated part, without nodal forces [J]. */
inline double lagrangian(const MixedRod& rod, const State& state)
{
  double value = 0.0;
  for (int i = state.first_node; i < rod.nodes(); ++i)
    value += turningTerm(rod, state, i);
  for (int j = state.first_node; j + 1 < rod.nodes(); ++j)
  {
    const MixedEdge& edge = rod.edges()[j];
    const double h = edge.length;
    const Eigen::Vector3d& m0 = state.moment[j];
    const Eigen::Vector3d& m1 = state.moment[j + 1];
    const Eigen::Vector3d& k0 = edge.rest_curvature[0];
    const Eigen::Vector3d& k1 = edge.rest_curvature[1];
    const Eigen::Vector3d first = edge.flexibility * m0 + k0;
    const Eigen::Vector3d second = edge.flexibility * m1 + k1;
    const double squares = first.squaredNorm() + second.squaredNorm();
    const double shortening = h * h * h * (8.0 * squares + 14.0 * first.dot(second)) / 720.0;
    // ∫y²/EI of the cubic bow whose curvature is linear between those at the ends.
    const double bow_compliance =
        h * h * h * h * h * edge.flexibility * (2.0 / 945.0 * squares + 31.0 / 7560.0 * first.dot(second));
    const Eigen::Vector3d chord = state.position[j + 1] - state.position[j];
    const double tension = state.tension[j];
    value -= h * edge.flexibility / 6.0 * (m0.squaredNorm() + m0.dot(m1) + m1.squaredNorm());
    value -= h / 6.0 * (m0.dot(2.0 * k0 + k1) + m1.dot(k0 + 2.0 * k1));
    value += tension * (chord.norm() - h + shortening) -
             0.5 * tension * tension * (h * edge.axial_compliance + bow_compliance);
    const Eigen::Vector3d bow = (h * h * h / 24.0) * (first + second).cross(chord.normalized());
    value -= edge.load.dot(0.5 * h * (state.position[j] + state.position[j + 1]) - bow);
  }
  return value;
}

}  // namespace endovascular_sim::rod
