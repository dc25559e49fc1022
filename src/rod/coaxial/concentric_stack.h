#pragma once

#include <vector>

#include "rod/coaxial/layer_profile.h"

namespace endovascular_sim::rod
{

/** Instrument of a stack, in which each lies inside the next. */
struct Layer
{
  Wire wire;
  double friction = 0.0;  ///< Coulomb coefficient with the next outer layer [1]
  double fit_load = 0.0;  ///< normal load between the two without bending [N/m]
  double lumen = 0.0;     ///< radius of the layer's own lumen; 0: it fits the layers inside without clearance [m]
};

/** Several instruments on one centreline, as one rod (docs/PHYSICS.md, "Concentric stack").
 *
 *  All layers are isotropic in bending. The sum of their energies, Σ B_k/c |κb − κ̄b_k|²/2, is therefore that of one rod
 *  with the stiffness B = Σ B_k and the rest curvature Σ B_k κ̄b_k / B, up to a constant. Only the twist is each layer's
 *  own. The last node is the tip of the reference, the layer that reaches furthest: a change of the reference where two
 *  tips coincide changes no node. */
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

  /** Sets the nodes of all layers. */
  void setNodes(const std::vector<double>& position);

  /** Slides every layer over the nodes, and updates the properties of the rod of all layers.
   *  @param behind distance of every layer's tip behind that of the reference [m]
   *  @param rod has the nodes of the stack */
  void place(const std::vector<double>& behind, Discretisation& rod);

  /** Part of a node's outer surface that belongs to a layer, 0 to 1; the parts of all layers add up to 1. */
  double outerShare(int k, int node) const
  {
    return outer_share_[static_cast<std::size_t>(node) * static_cast<std::size_t>(count()) +
                        static_cast<std::size_t>(k)];
  }

  /** Layer in contact with the wall at a node: the outermost one that covers half of the node. */
  int surfaceLayer(int node) const { return surface_layer_[node]; }

  /** Part of a node that two layers both cover, 0 to 1. */
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
