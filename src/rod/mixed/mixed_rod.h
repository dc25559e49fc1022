#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "rod/linear/banded_ldlt.h"
#include "rod/model/state.h"
#include "rod/model/wire.h"
#include "rod/stepping/stepper.h"

namespace endovascular_sim::rod
{

/** Part of a wire between two nodes of the mixed rod. Sections change at nodes only. */
struct MixedEdge
{
  double length = 0.0;             ///< h, rest arc length [m]
  double flexibility = 0.0;        ///< 1/EI [1/(N·m²)]
  double axial_compliance = 0.0;   ///< 1/EA, 0: inextensible [1/N]
  double twist_flexibility = 0.0;  ///< 1/GJ [1/(N·m²)]
  double linear_density = 0.0;     ///< ρA [kg/m]
  double cross_section = 0.0;      ///< A, displaced volume of fluid per length [m²]
  /** κ̄ at the edge's two ends, in space, along the binormal [1/m]. */
  std::array<Eigen::Vector3d, 2> rest_curvature{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  Eigen::Vector2d material_curvature = Eigen::Vector2d::Zero();  ///< rest curvature in the material frame [1/m]
  Eigen::Vector3d load = Eigen::Vector3d::Zero();                ///< force per length of wire [N/m]
};

/** Hold of an end of the mixed rod, at its node. */
struct MixedEnd
{
  EndHold hold = EndHold::kFree;
  Eigen::Vector3d tangent = Eigen::Vector3d::UnitX();  ///< direction of a clamp, towards the tip, unit
};

/** Edges of the mixed rod between given arc lengths of a wire, with properties averaged over each edge. Loads and the
 *  rest curvature in space are zero.
 *  @param position strictly increasing, from 0 to the wire's length, at least 3 */
std::vector<MixedEdge> mixedEdges(const Wire& wire, const std::vector<double>& position);

/** Rod of fourth order: a mixed (Hellinger–Reissner) form with the bending moment as a second unknown per node.
 *
 *  Nodes lie on the curve, edge j is a chord of it. The state is a stationary point (a minimum in x, a maximum in M
 *  and λ) of
 *
 *    L = Σ_i M_i·Φ_i − Σ_j [ h/(6EI) (|M_j|² + M_j·M_{j+1} + |M_{j+1}|²) + h/6 (M_j·(2κ̄_j + κ̄_{j+1}) + M_{j+1}·(κ̄_j +
 *        2κ̄_{j+1})) ] + Σ_j [ λ_j (|e_j| − h + s_j) − ½ λ_j² (h/EA + b_j) ] − W
 *    s_j = h³ (8|κ_j|² + 14 κ_j·κ_{j+1} + 8|κ_{j+1}|²)/720, κ = M/EI + κ̄: the arc's length less the chord's
 *    b_j = ∫y²/EI over the edge, y the distance of the arc from the chord
 *    W = Σ_i F_i·x_i + Σ_j q·( h (x_j + x_{j+1})/2 − h³/24 (κ_j + κ_{j+1})×t_j )
 *
 *  with Φ_i the turning angle vector between the chords, at a clamp between its tangent and the chord. The method is of
 *  fourth order in h for nodal forces and for q constant along an edge.
 *
 *  b is of the order h⁵, below that of the method, but it is needed for stability. Without it the chord's compliance
 *  −∂²L/∂λ² is negative once M is eliminated, and motion is unstable where Δt²/m is smaller. −½M²h/EI + λs − ½λ²b are
 *  the first terms of the complementary energy of a beam under tension, concave in (M, λ).
 *
 *  Unknowns are ordered x0, M0, x1, M1, λ0, x2, M2, λ1, …: half bandwidth 16. Where inertia or load make the x block
 *  positive, the matrix is quasi-definite with 4(n − 1) + 3 negative pivots. */
class MixedRod
{
public:
  static constexpr int kBandwidth = 16;
  using Matrix = BandedLdlt<kBandwidth>;

  MixedRod(std::vector<MixedEdge> edges, MixedEnd proximal, MixedEnd distal);

  int nodes() const { return static_cast<int>(edges_.size()) + 1; }
  double length() const;
  const std::vector<MixedEdge>& edges() const { return edges_; }
  MixedEdge& edge(int index) { return edges_[static_cast<std::size_t>(index)]; }
  const MixedEnd& proximal() const { return proximal_; }
  const MixedEnd& distal() const { return distal_; }

  /** Number of unknowns from the state's first node on. */
  int size(const State& state) const { return 7 * (nodes() - state.first_node) - 1; }

  static int positionRow(const State& state, int node) { return momentRow(state, node) - 3; }
  static int momentRow(const State& state, int node)
  {
    return node == state.first_node ? 3 : 7 * (node - state.first_node) + 2;
  }
  static int tensionRow(const State& state, int edge) { return 7 * (edge - state.first_node) + 12; }

  /** A straight unloaded wire from @p origin along @p direction (unit). */
  State straight(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;

  /** Adds ∂L/∂(x, M, λ) to @p gradient and the second derivatives to @p hessian, both of size(state). */
  void assemble(const State& state, std::vector<double>& gradient, Matrix& hessian) const;

  /** Prescribes the ends: positions of held ends, zero moment where an end may turn.
   *  @param rhs right-hand side, of the same system */
  void prescribeEnds(const State& state, Matrix& matrix, std::vector<double>& rhs) const;

  /** Prescribes a zero increment of one node's position, or of its moment. */
  static void prescribe(int first_row, double pivot, Matrix& matrix, std::vector<double>& rhs);

  int negativePivots(const State& state) const { return 4 * (nodes() - state.first_node) - 1; }

  /** Strain of an edge, the residual of its constraint: chord plus shortening less the arc's length, over that [1]. */
  double strain(const State& state, int edge) const;

  /** Elastic bending energy ½∫EI|κ − κ̄|² of the simulated part at equilibrium, of fourth order in h [J]. */
  double bendingEnergy(const State& state) const;

private:
  /** First and second derivatives by a chord. */
  struct Chord
  {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  };

  bool turnsFreely(const State& state, int node) const;
  Eigen::Vector3d chordBefore(const State& state, int node) const;
  Eigen::Vector3d chordAfter(const State& state, int node) const;
  void assembleNode(const State& state, int node, Chord& before, Chord& after, std::vector<double>& gradient,
                    Matrix& hessian) const;
  void assembleEdge(const State& state, int edge, Chord& chord, std::vector<double>& gradient, Matrix& hessian) const;
  void assembleBow(const State& state, int edge, Chord& chord, std::vector<double>& gradient, Matrix& hessian) const;
  static void scatter(const State& state, int edge, const Chord& chord, std::vector<double>& gradient, Matrix& hessian);

  std::vector<MixedEdge> edges_;
  MixedEnd proximal_;
  MixedEnd distal_;
};

}  // namespace endovascular_sim::rod
