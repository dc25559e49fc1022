#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/coaxial/concentric_stack.h"
#include "rod/kkt/interlayer_loads.h"
#include "rod/kkt/kkt_model.h"
#include "rod/kkt/layer_twists.h"

namespace endovascular_sim::rod
{

/** Coulomb friction between neighbouring layers of a stack, along the wire and about its axis.
 *
 *  Inextensible layers on one centreline have the same relative axial displacement everywhere: one stretch per pair of
 *  neighbours describes stick and slip. About the axis a pair sticks at the mean relative angle, weighted with the
 *  friction. */
class InterlayerFriction
{
public:
  /** @param stack, model must outlive this */
  InterlayerFriction(const ConcentricStack& stack, const KktModel& model);

  /** Next layer outside of one that is in the vessel too; −1 without. */
  int nextOuter(int k, const State& state) const;

  /** Advances the stretches of all pairs to the insertions at the end of a step. */
  void drag(State& state, const StepInput& input) const;

  /** Updates the normal loads between neighbours. */
  void updateLoads(State& state, const LayerTwists& twists);

  /** Axial friction force of the next outer layer on a layer, positive against insertion [N]. */
  double axialForce(int k, int outer, const State& state) const;

  /** Work of the friction torque between a layer and the next outer one in a part of a step [J]. */
  double turnWork(int k, int outer, const State& before, const State& after) const;

  /** Updates the largest friction torques between neighbours. */
  void updateTorqueLimits(const State& state);

  /** Whether there are friction torques on a layer. */
  bool hasTorques(int k, const State& state) const;

  /** Adds the friction torques on every edge of a layer [N·m]. */
  void addTorques(int k, const State& state, std::vector<double>& edge_torque) const;

  /** Changes the friction torques towards those with which every pair sticks at its angle, within friction's limit.
   *  @param held arc length at which the proximal end holds the twist [m]
   *  @param first true before the first change in this solve
   *  @return true when the twists must be relaxed again */
  bool updateTorques(State& state, double held, bool first);

  /** Updates the angles at which the pairs stick, at the end of a step: a pair that slips sticks at its new angle. */
  void settle(State& state) const;

private:
  void updateVesselShares(const State& state);
  double load(int k, int outer, int node, const State& state) const;
  bool canStick(int k, const State& state) const;
  double torqueShare(int m, int k, const State& state) const;
  double meanTurn(int k, int outer, const State& state) const;
  double turnCompliance(int k, int outer, double held) const;
  double turnPerShare(int k, double turn, double share, double compliance, bool first) const;

  const ConcentricStack& stack_;
  const KktModel& model_;
  std::vector<double> turn_before_, share_before_;  ///< angle and share of every pair before the last change
  std::vector<std::vector<double>>
      torque_limit_;                  ///< largest friction torque with the next outer layer, per edge [N·m]
  std::vector<double> vessel_share_;  ///< part of every node's cell that is in the vessel, 0 to 1
  InterlayerLoads loads_;
  std::vector<LayerPair> pairs_;
};

}  // namespace endovascular_sim::rod
