#pragma once

#include <vector>

#include "rod/kkt/layer_profile.h"

namespace endovascular_sim::rod
{

/** One of several instruments, one inside the other. */
struct Layer
{
  Wire wire;
  double friction = 0.0;  ///< Coulomb coefficient with the next outer layer
  double fit_load = 0.0;  ///< normal load with which the two press on each other even when nothing bends [N/m]
};

/** Several instruments on one centreline, as one rod (docs/PHYSICS.md, "Concentric stack").
 *
 *  All layers are isotropic in bending, so that the sum of their energies Σ B_k/c |κb − κ̄b_k|²/2 is that of one rod
 * with the stiffness B = Σ B_k and the rest curvature Σ B_k κ̄b_k / B, up to a constant. Only twist is each layer's own.
 *  The nodes are measured from the tip of the reference, the layer that reaches furthest, which is always at the last
 *  node: a change of the reference where two tips coincide changes no node. */
class ConcentricStack
{
public:
  /** @param layers from the inside out, at least one
   *  @param position of the nodes, from 0 to the longest wire's length [m]
   *  @throws std::invalid_argument when they do not end there */
  ConcentricStack(std::vector<Layer> layers, const std::vector<double>& position);

  int count() const { return static_cast<int>(profiles_.size()); }
  const Layer& layer(int k) const { return layers_[k]; }
  const LayerProfile& profile(int k) const { return profiles_[k]; }

  /** Other nodes for all. */
  void setNodes(const std::vector<double>& position);

  /** Slides every layer to how far its tip lies behind the reference's [m], and updates the rod of them all.
   *  @param rod has the nodes of the stack */
  void place(const std::vector<double>& behind, Discretisation& rod);

  /** Share of a node's surface that is a layer's, 0 to 1; all layers' shares together are 1. */
  double outerShare(int k, int node) const { return outer_share_[static_cast<std::size_t>(node * count() + k)]; }

  /** The layer whose surface a node's contacts are with: the outermost that covers half of it. */
  int surfaceLayer(int node) const { return surface_layer_[node]; }

  /** Share of a node that two layers cover both, 0 to 1. */
  double overlap(int k, int m, int node) const;

private:
  void composeNode(int node, Discretisation& rod);

  std::vector<Layer> layers_;
  std::vector<LayerProfile> profiles_;
  std::vector<double> outer_share_;
  std::vector<int> surface_layer_;
  std::vector<int> changed_;
  double end_ = 0.0;
};

}  // namespace endovascular_sim::rod
