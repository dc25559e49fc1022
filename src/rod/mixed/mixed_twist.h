#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "rod/mixed/mixed_rod.h"
#include "rod/twist/twist.h"

namespace endovascular_sim::rod
{

/** Quasi-static twist of the mixed rod, fourth order in h: torque T at nodes, one angle θ per edge of the material
 * frame that goes with the chord against the Bishop frame transported along the chords.
 *
 *  The whole moment at a node is m = M + T τ, τ along the bisector of the chords. In equilibrium
 *  - moment is balanced exactly: the force in an edge is u×(m_{j+1} − m_j)/|e| + λu and (m_{j+1} − m_j)·u =
 *    h³/12 q·κ, which gives T from the tip on;
 *  - the material frames that edge_shape.h finds for the end of one edge and the beginning of the next are the same at
 *    the node between: about the tangent this is the equation for θ, across it the one for M.
 *  L of mixed_rod.h is left as it is; assemble() adds what these equations have beyond its gradient.
 *
 *  The angles are relaxed at fixed curvature of the centreline (so at fixed x, not at fixed M), the torque's change by
 *  the angles being that of the energy −∫EI κ·κ̄, which follows a snap-through; the rod's Newton method then runs at
 *  fixed angles, without the twist's answer in its second derivatives. */
class MixedTwist
{
public:
  /** @return true when the twist influences anything: rest curvature, or a torque at the tip */
  static bool matters(const MixedRod& rod, double tip_torque);

  /** Relaxes state.twist_angle, sets state.hand_torque and the rest curvatures of the rod's edges in space.
   *  @param boundary its position says where along the wire the twist begins to count: edges before it neither twist
   *  nor bend by themselves */
  void relax(MixedRod& rod, const TwistBoundary& boundary, State& state);

  /** Adds what the torque and the frames contribute at the state last relaxed. */
  void assemble(const MixedRod& rod, const State& state, std::vector<double>& gradient,
                MixedRod::Matrix& hessian) const;

  /** Torque at a node [N·m]. */
  double torque(int node) const { return torque_[static_cast<std::size_t>(node)]; }

  /** The whole moment at a node, in space [N·m]. */
  const Eigen::Vector3d& moment(int node) const { return moment_[static_cast<std::size_t>(node)]; }

  /** Elastic energies [J]; of the state last relaxed, fourth order in h. */
  Energy energy(const State& state) const;

private:
  using Matrix = BandedLdlt<2>;

  /** An edge with its material frame. */
  struct Edge
  {
    Eigen::Vector3d tangent, bishop, bishop_normal;
    std::array<Eigen::Matrix3d, 2> end;  ///< material frames at the ends, in space
    Eigen::Vector3d curvature;           ///< in the middle, in space [1/m]
    Eigen::Vector3d rest_curvature;      ///< in the material frame [1/m]
    Energy energy;                       ///< [J]
    double inverse;                      ///< of the chord's length [1/m]
    double share;                        ///< of the edge that lies beyond the held place
    double flexibility;                  ///< 1/GJ, next to none before the held place [1/(N·m²)]
    double load_torque;                  ///< (m_{j+1} − m_j)·u [N·m]
    double angle;                        ///< θ before it relaxes [rad]
    double rise;                         ///< T_{j+1} − T_j there [N·m]
    double sine, cosine;  ///< of θ's change in T_{j+1} − T_j, from the energy of bending at fixed curvature [N·m]
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
  double angle_before_ = 0.0;  ///< of the frame that holds the wire [rad]
  std::vector<Edge> edges_;
  std::vector<double> torque_;
  std::vector<double> missing_;          ///< twist at nodes that the frames ask for beyond that of the torques [rad]
  std::vector<Eigen::Vector3d> axis_;    ///< τ
  std::vector<Eigen::Vector3d> moment_;  ///< m [N·m]
  Matrix matrix_;
  std::vector<double> rhs_;
};

}  // namespace endovascular_sim::rod
