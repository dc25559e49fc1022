#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/kkt/concentric_stack.h"
#include "rod/kkt/layer_model.h"
#include "rod/twist/twist.h"

namespace endovascular_sim::rod
{

/** Twists of the layers of a stack on their shared centreline, and their common action on it. */
class LayerTwists
{
public:
  explicit LayerTwists(int layers) : twist_(layers), active_(layers, 0) {}

  /** Computes the quasi-static twist of one layer: its twist angles and the torque at its handle.
   *  @param layer the layer as a rod of its own
   *  @param again the centreline is that of the last call */
  void relax(int k, const Discretisation& layer, const TwistBoundary& boundary, State& state, bool again);

  /** Combines the twists: the mean of the layers' rest curvatures, weighted with their stiffnesses, and the sum of
   * their torques.
   *  @param rod of all layers together */
  TwistAction combine(const ConcentricStack& stack, const Discretisation& rod, const State& state);

  /** True where the twist of a layer acts on the centreline. */
  bool isActive(int k) const { return active_[k] != 0; }

  const QuasiStaticTwist& of(int k) const { return twist_[k]; }

  /** First node with rest curvature of any layer. */
  int firstCurved() const { return first_curved_; }

  /** Combined rest curvature binormal of a node from firstCurved() on [1]. */
  const Eigen::Vector3d& restBinormal(int node) const { return rest_binormal_[node]; }

private:
  std::vector<QuasiStaticTwist> twist_;
  std::vector<char> active_;
  std::vector<Eigen::Vector3d> rest_binormal_;
  std::vector<double> torque_;
  int first_curved_ = 0;
};

}  // namespace endovascular_sim::rod
