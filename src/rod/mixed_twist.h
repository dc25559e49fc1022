#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "rod/mixed_rod.h"
#include "rod/twist.h"

namespace endovascular_sim::rod
{

/** Quasi-static twist of the mixed rod: torque T at nodes, linear along edges, and the mean angle θ of every edge's
 *  material frame against the Bishop frame transported along the chords.
 *
 *  To L of mixed_rod.h it adds Σ_i T_i (θ^i − θ^{i−1} − C_i) − Σ_j h/(6GJ) (T_j² + T_j T_{j+1} + T_{j+1}²) − (torque at
 *  the tip)·θ, stationary in T and θ, and turns the rest curvature with the frames:
 *  - C_i = t·κ×κ′ times (h_a + h_b)(h_a² + h_a h_b + h_b²)/48, at a clamp h³/48: by how much the chords' Bishop frame
 *    turns against the curve's own at a node;
 *  - κ̄ is evaluated at an edge's two Gauss points, in the edge's frame turned by ∓(√3/6) h times the mean curvature and
 *    twist, and handed to the rod as the linear function through both.
 *
 *  The angles are relaxed at fixed curvature of the centreline (so at fixed x, not at fixed M); the rod's Newton method
 *  then runs at fixed angles, without the twist's answer in its second derivatives.
 *
 *  Order, measured: 4 where the frames do not turn (rest curvature bent in its plane); about 3 under a torque at a free
 *  tip; 2 for rest curvature bent out of its plane, where the torque varies along the wire (the moments at nodes then
 *  carry a share of it, of the order h², that these terms do not return). */
class MixedTwist
{
public:
  /** @return true when the twist influences anything: rest curvature, or a torque at the tip */
  static bool matters(const MixedRod& rod, double tip_torque);

  /** Relaxes state.twist_angle, sets state.hand_torque and the rest curvatures of the rod's edges in space.
   *  @param boundary its position says where along the wire the twist begins to count: edges before it neither twist
   *  nor bend by themselves */
  void relax(MixedRod& rod, const TwistBoundary& boundary, State& state);

  /** Adds what the torque and the turning rest curvature contribute at the state last relaxed. */
  void assemble(const MixedRod& rod, const State& state, std::vector<double>& gradient,
                MixedRod::Matrix& hessian) const;

  /** Torque at a node [N·m]. */
  double torque(int node) const { return torque_[static_cast<std::size_t>(node)]; }

  /** Energy of the twist alone, ½∫T²/GJ [J]; of the state last relaxed. */
  double energy(const MixedRod& rod, const State& state) const;

private:
  using Matrix = BandedLdlt<2>;

  /** An edge with its material frame. */
  struct Edge
  {
    Eigen::Vector3d tangent, bishop, bishop_normal;
    std::array<Eigen::Vector3d, 2> curvature;  ///< κ at the ends, fixed while the angles relax [1/m]
    std::array<Eigen::Vector3d, 2> gauss;      ///< κ̄ at the Gauss points [1/m]
    std::array<Eigen::Vector3d, 2> end;        ///< κ̄ at the ends [1/m]
    std::array<Eigen::Vector3d, 2> by_end;     ///< −Σ T ∂C/∂κ at the ends [N·m·m]
    Eigen::Vector3d spin;                      ///< derivative of L by a rotation of the edge's frame [N·m]
    Eigen::Vector3d turn;                      ///< from the chord's frame to the second Gauss point's [rad]
    double share;                              ///< of the edge that lies beyond the held place
    double flexibility;                        ///< 1/GJ, next to none before the held place [1/(N·m²)]
  };

  void transportBishopFrame(const MixedRod& rod, const TwistBoundary& boundary, const State& state);
  void placeRestCurvature(const MixedRod& rod, const State& state, int edge);
  static void extrapolate(Edge& edge);
  void findCurvature(const MixedRod& rod, const State& state);
  void evaluate(const MixedRod& rod, const State& state);
  void solve(const MixedRod& rod, const TwistBoundary& boundary, const State& state);
  double holonomy(const MixedRod& rod, int node);

  int first_ = 0;
  std::vector<Edge> edges_;
  std::vector<double> torque_;
  std::vector<Eigen::Vector3d> corrections_;  ///< bending moment less M, at nodes [N·m]
  Matrix matrix_;
  std::vector<double> rhs_;
};

}  // namespace endovascular_sim::rod
