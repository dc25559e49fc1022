#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "rod/mixed/mixed_rod.h"
#include "rod/twist/twist.h"

namespace endovascular_sim::rod
{

/** Quasi-static twist of the mixed rod, of fourth order in h: torque T at nodes, and one angle θ per edge from the
 * Bishop frame, transported along the chords, to the material frame of the chord.
 *
 *  The whole moment at a node is m = M + T τ, τ along the bisector of the chords. In equilibrium
 *  - moments balance exactly: the force in an edge is u×(m_{j+1} − m_j)/|e| + λu, and (m_{j+1} − m_j)·u = h³/12 q·κ,
 *    which gives T from the tip on;
 *  - the material frames of RodEdgeFrames at the end of one edge and the beginning of the next coincide at the node
 *    between: about the tangent this is the equation for θ, across it the equation for M.
 *  L of mixed_rod.h is not changed; assemble() adds the terms of these equations beyond its gradient.
 *
 *  The angles are relaxed at fixed curvature of the centreline (at fixed x, not at fixed M). The derivative of the
 * torque by the angles is that of the energy −∫EI κ·κ̄, with which a snap-through converges. The rod's Newton method
 * then runs at fixed angles, without the response of the twist in its second derivatives. */
class MixedTwist
{
public:
  /** True when the twist acts on the wire: with rest curvature, or a torque at the tip. */
  static bool matters(const MixedRod& rod, double tip_torque);

  /** Relaxes state.twist_angle, and sets state.hand_torque and the rest curvatures of the rod's edges in space.
   *  @param boundary its position is the arc length at which twist and rest curvature begin */
  void relax(MixedRod& rod, const TwistBoundary& boundary, State& state);

  /** Adds the terms of the torque and of the frames at the state last relaxed. */
  void assemble(const MixedRod& rod, const State& state, std::vector<double>& gradient,
                MixedRod::Matrix& hessian) const;

  /** Torque at a node [N·m]. */
  double torque(int node) const { return torque_[static_cast<std::size_t>(node)]; }

  /** Whole moment at a node, in space [N·m]. */
  const Eigen::Vector3d& moment(int node) const { return moment_[static_cast<std::size_t>(node)]; }

  /** Elastic energies of the state last relaxed, of fourth order in h [J]. */
  Energy energy(const State& state) const;

private:
  using Matrix = BandedLdlt<2>;

  /** Edge with its material frame. */
  struct Edge
  {
    Eigen::Vector3d tangent, bishop, bishop_normal;
    std::array<Eigen::Matrix3d, 2> end;  ///< material frames at the ends, in space
    Eigen::Vector3d curvature;           ///< curvature in the middle, in space [1/m]
    Eigen::Vector3d rest_curvature;      ///< components in the material frame [1/m]
    Energy energy;                       ///< [J]
    double inverse;                      ///< inverse of the chord's length [1/m]
    double share;                        ///< part of the edge that lies beyond the hold
    double flexibility;                  ///< 1/GJ, negligible before the hold [1/(N·m²)]
    double load_torque;                  ///< (m_{j+1} − m_j)·u [N·m]
    double angle;                        ///< θ at the linearisation [rad]
    double rise;                         ///< T_{j+1} − T_j at the linearisation [N·m]
    double sine, cosine;  ///< coefficients of sin and cos of the change of θ in T_{j+1} − T_j, at fixed curvature [N·m]
  };

  void transportBishopFrame(const MixedRod& rod, const TwistBoundary& boundary, const State& state);
  void findAxes(const MixedRod& rod, const State& state);
  void findTorque(const State& state, double tip_torque);
  void findMoments(const MixedRod& rod, const State& state);
  void shapeEdge(const MixedRod& rod, const State& state, int edge);
  void evaluate(const MixedRod& rod, const State& state, double tip_torque);
  void linearise(const MixedRod& rod, const TwistBoundary& boundary, const State& state);
  double twistMismatch(const TwistBoundary& boundary, int node) const;
  double twistBetween(const MixedRod& rod, const State& state, int node) const;
  void solve(const MixedRod& rod, const TwistBoundary& boundary, const State& state);
  void assembleForce(const MixedRod& rod, const State& state, int edge, std::vector<double>& gradient) const;
  Eigen::Vector3d bendOfEdge(const MixedRod& rod, const State& state, int edge, int side) const;
  void assembleNode(const MixedRod& rod, const State& state, int node, std::vector<double>& gradient) const;
  void assembleRestCurvature(const MixedRod& rod, const State& state, int edge, MixedRod::Matrix& hessian) const;

  int first_ = 0;
  double angle_before_ = 0.0;  ///< angle of the frame that holds the wire [rad]
  std::vector<Edge> edges_;
  std::vector<double> torque_;
  std::vector<double> missing_;          ///< twist at nodes by the frames less that by the torques [rad]
  std::vector<Eigen::Vector3d> axis_;    ///< τ
  std::vector<Eigen::Vector3d> moment_;  ///< m [N·m]
  Matrix matrix_;
  std::vector<double> rhs_;
};

}  // namespace endovascular_sim::rod
