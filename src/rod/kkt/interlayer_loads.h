#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/coaxial/bore_contact.h"
#include "rod/coaxial/concentric_stack.h"
#include "rod/kkt/kkt_model.h"
#include "rod/kkt/layer_twists.h"

namespace endovascular_sim::rod
{

/** Neighbouring layers of a stack that are both in the vessel. */
struct LayerPair
{
  int inner = 0;
  int outer = 0;
  double friction = 0.0;   ///< Coulomb coefficient [1]
  double mobilised = 0.0;  ///< acting part of the friction along the wire, −1 to 1; positive against insertion
};

/** Normal loads between neighbouring layers (docs/PHYSICS.md, "Friction between layers").
 *
 *  The layers inside a gap are one wire in the bore of the next layer, whose axis is the centreline. Its tension is
 * that of the stack beyond the tip of the outer layer, and from there to the introducer it changes with its curvature
 * and with the friction in the gap. The friction is that of the loads of the last step. */
class InterlayerLoads
{
public:
  /** @param stack, model must outlive this */
  InterlayerLoads(const ConcentricStack& stack, const KktModel& model) : stack_(stack), model_(model) {}

  /** Updates the loads of all pairs with friction.
   *  @param pairs from the inside out
   *  @param vessel_share part of every node's cell with friction, 0 to 1 */
  void update(const std::vector<LayerPair>& pairs, const std::vector<double>& vessel_share, const LayerTwists& twists,
              State& state);

private:
  void updateCentreline(const State& state);
  void updateMoments(const LayerTwists& twists, const State& state);
  void updateStackTension(const State& state);
  void updatePair(const LayerPair& pair, const std::vector<double>& vessel_share, State& state);
  double groupCover(int k, int node) const;
  double groupRadius(int k, int node) const;
  int lastCommonNode(const LayerPair& pair, const State& state) const;
  double protrusion(const LayerPair& pair, int end) const;
  void placeNodes(const LayerPair& pair, int end, const State& state);
  void updateTension(const LayerPair& pair, int end, const std::vector<double>& vessel_share, const State& state);
  Eigen::Vector2d across(const Eigen::Vector3d& vector, int node) const;

  const ConcentricStack& stack_;
  const KktModel& model_;
  BoreContact bore_;
  std::vector<Eigen::Vector3d> binormal_, tangent_, director_, normal_;  ///< of every node; Bishop frame
  std::vector<std::vector<Eigen::Vector3d>> moment_;  ///< bending moment of every layer and those inside it [N·m]
  std::vector<double> tension_;  ///< of the layers inside the present gap; beyond its outer layer, of the stack [N]
  std::vector<BoreNode> nodes_;  ///< of the present pair, from the first node of the state on
};

}  // namespace endovascular_sim::rod
