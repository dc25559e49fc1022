#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/coaxial/bore_contact.h"
#include "rod/coaxial/concentric_stack.h"
#include "rod/kkt/kkt_model.h"
#include "rod/kkt/layer_twists.h"
#include "rod/model/bending.h"

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

/** Normal loads between neighbouring layers (docs/PHYSICS.md, "Normal load between layers").
 *
 *  The layers inside a gap are one wire in the bore of the next layer, whose axis is the centreline. Its tension is
 * that of the stack beyond the tip of the outer layer, and from there to the introducer it changes with its curvature
 * and with the friction in the gap. Tension, load and friction are those of one solution: the load is linear in the
 * tension near the last solution in the bore, the tension follows from the friction of that load, and both are
 * repeated while the tension changes. A wire under compression bears at least with the load of its helix. */
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
  /** Load of a solution in the bore, near the tension of that solution; the slope is that of a covered node. */
  struct BoreLoad
  {
    double value = 0.0;    ///< at the tension of the solution, per length of wall [N/m]
    double tension = 0.0;  ///< mean of the tensions on both sides of the node [N]
    double slope = 0.0;    ///< change with that mean [1/m]
  };

  void updateCentreline(const State& state);
  void updateMoments(const LayerTwists& twists, const State& state);
  void updateStackTension(const State& state);
  void updatePair(const LayerPair& pair, const std::vector<double>& vessel_share, State& state);
  double groupCover(int k, int node) const;
  double groupRadius(int k, int node) const;
  int lastCommonNode(const LayerPair& pair, const State& state) const;
  double protrusion(const LayerPair& pair, int end) const;
  void placeNodes(const LayerPair& pair, int end, const State& state);
  double updateTension(const LayerPair& pair, int end, int first, const std::vector<double>& vessel_share);
  double tensionBefore(std::size_t i, double tension, double after, double friction, double fit_load);
  void updateBoreLoads();
  double tolerance() const;
  Eigen::Vector2d across(const Eigen::Vector3d& vector, int node) const;

  const ConcentricStack& stack_;
  const KktModel& model_;
  BoreContact bore_;
  int end_ = 0;                               ///< after the last node whose centreline the pairs need
  std::vector<CurvatureBinormal> curvature_;  ///< of the nodes up to there, from the second simulated one on
  std::vector<Eigen::Vector3d> binormal_, tangent_, director_, normal_;  ///< of the same nodes; Bishop frame
  std::vector<std::vector<Eigen::Vector3d>> moment_;  ///< bending moment of every layer and those inside it [N·m]
  std::vector<double> tension_;      ///< of the layers inside the present gap; beyond its outer layer, of the stack [N]
  std::vector<BoreNode> nodes_;      ///< of the present pair, from the first node of the state on
  std::vector<BoreLoad> bore_load_;  ///< of the last solution in the bore, at these nodes
  std::vector<double> load_;         ///< with the helix, at these nodes [N/m]
};

}  // namespace endovascular_sim::rod
