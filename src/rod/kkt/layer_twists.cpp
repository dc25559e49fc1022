#include "rod/kkt/layer_twists.h"

#include <algorithm>
#include <utility>

namespace endovascular_sim::rod
{

void LayerTwists::relax(int k, const Discretisation& layer, const TwistBoundary& boundary, State& state, bool again)
{
  LayerState& of_layer = state.layers[k];
  if (layer.nodes() < state.first_node + 3 || !QuasiStaticTwist::matters(layer, boundary))
  {
    std::fill(of_layer.twist_angle.begin() + state.first_node, of_layer.twist_angle.end(), of_layer.rotation);
    of_layer.hand_torque = 0.0;
    active_[k] = 0;
    return;
  }
  std::swap(state.twist_angle, of_layer.twist_angle);
  twist_[k].solve(layer, boundary, state, again && isActive(k));
  of_layer.hand_torque = state.hand_torque;
  std::swap(state.twist_angle, of_layer.twist_angle);
  const auto last = of_layer.twist_angle.begin() + (layer.nodes() - 2);
  std::fill(last + 1, of_layer.twist_angle.end(), *last);
  active_[k] = 1;
}

TwistAction LayerTwists::combine(const ConcentricStack& stack, const Discretisation& rod, const State& state)
{
  const int n = rod.nodes();
  first_curved_ = n;
  if (std::find(active_.begin(), active_.end(), 1) == active_.end())
    return {};
  rest_binormal_.resize(n);
  torque_.assign(n, 0.0);
  for (int k = 0; k < stack.count(); ++k)
    if (isActive(k))
      first_curved_ = std::min(first_curved_, twist_[k].firstCurved());
  for (int i = first_curved_; i < n; ++i)
    rest_binormal_[i].setZero();
  for (int k = 0; k < stack.count(); ++k)
  {
    if (!isActive(k))
      continue;
    const Discretisation& layer = stack.profile(k).rod();
    for (int i = state.first_node; i + 1 < layer.nodes(); ++i)
      torque_[i] += twist_[k].torque(i);
    for (int i = twist_[k].firstCurved(); i + 1 < layer.nodes(); ++i)
      rest_binormal_[i] += (layer.bending_stiffness[i] / rod.bending_stiffness[i]) * twist_[k].restCurvatureBinormal(i);
  }
  return {true, first_curved_, rest_binormal_.data(), torque_.data()};
}

}  // namespace endovascular_sim::rod
