#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/model/discretisation.h"
#include "rod/model/state.h"
#include "rod/twist/surface_twist.h"
#include "rod/twist/twist.h"

namespace endovascular_sim::rod
{

/** Coupling of turns and positions: with it, a solve whose unknowns are both is Newton's method on the energy.
 *
 *  A turn τ of an edge is that about its tangent t, relative to the frame that follows the edge without turning about
 *  it. The bending energy of a node is ½B|κb − ω̄|²/l, with the rest curvature binormal ω̄ in the material frames of its
 *  edges and the moment M = B(κb − ω̄)/l. Beyond the Gauss–Newton form Jᵀ(B/l)J, J = ∂κb/∂x, its second derivatives are
 *
 *      ∂²E/∂x∂τ_j = −B/l Jᵀ(t_j × ω̄_j),
 *      ∂²E/∂x²    = M·∂²κb/∂x² − B/l Σ_j sym(ω̄_j κbᵀ)/|e_j|²,
 *
 *  where the last term is the tilt of the frames. The twist m = τ_i − τ_{i−1} + ∫κb/(2|ē|)·de (Bergou et al. 2010,
 *  eq. 7) has mixed derivatives too, and the direction of a compressed edge's force turns with the edge.
 *
 *  A rigid rotation of the whole has no stiffness then. The Gauss–Newton form alone resists the rotation of a curved
 * tip like a spring of stiffness Σ B|ω̄|²/l, and the hand would feel its torque per step: c Σ EI κ̄² ℓ ω Δt. */
class TurnCoupling
{
public:
  /** Begins with the terms that do not depend on the layers: those of the moment and of compressed edges.
   *  @param rod of all layers together
   *  @param rest its rest curvature binormals from @p first_curved on [1]
   *  @param surface gets the derivatives */
  TurnCoupling(const Discretisation& rod, const State& state, int first_curved,
               const std::vector<Eigen::Vector3d>& rest, SurfaceTwist& surface);

  /** Adds the rest curvature and the twist of a layer. Edges without an unknown turn in the surface have no mixed
   *  derivatives.
   *  @param layer the layer as a rod of its own
   *  @param twist of the layer after a solution at these positions
   *  @param owner layer whose turn is the unknown of every edge; null: there is only one */
  void addLayer(const Discretisation& layer, const QuasiStaticTwist& twist, int k, const std::vector<int>* owner);

private:
  void addRestCurvature(const Discretisation& layer, int node, const QuasiStaticTwist& twist);
  void addTwist(const Discretisation& layer, int node);
  void addMixed(int edge, int node, const Eigen::Vector3d& before, const Eigen::Vector3d& after);
  bool isUnknown(int edge) const;

  const Discretisation& rod_;
  const State& state_;
  SurfaceTwist& surface_;
  int layer_ = 0;
  const std::vector<int>* owner_ = nullptr;
};

}  // namespace endovascular_sim::rod
