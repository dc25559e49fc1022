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

void LayerTwists::rotate(int k, const Discretisation& layer, const TwistBoundary& boundary, double turn, State& state)
{
  LayerState& of_layer = state.layers[k];
  for (std::size_t j = static_cast<std::size_t>(state.first_node); j < of_layer.twist_angle.size(); ++j)
    of_layer.twist_angle[j] += turn;
  std::swap(state.twist_angle, of_layer.twist_angle);
  twist_[k].evaluateAt(layer, boundary, state);
  of_layer.hand_torque = state.hand_torque;
  std::swap(state.twist_angle, of_layer.twist_angle);
  active_[k] = 1;
}

void LayerTwists::linearise(int k, const Discretisation& layer, const TwistBoundary& boundary, State& state,
                            const std::vector<int>& on_surface, SurfaceTwist& surface)
{
  Chain& chain = chain_[k];
  chain.begin = chain.end = 0;
  if (!isActive(k))
    return;
  const int first = twist_[k].firstUnknown();
  const int last = layer.nodes() - 2;
  std::swap(state.twist_angle, state.layers[k].twist_angle);
  const QuasiStaticTwist::Model model = twist_[k].linearise(layer, boundary, state);
  std::swap(state.twist_angle, state.layers[k].twist_angle);
  chain.gradient.assign(model.gradient.begin(), model.gradient.end());
  chain.diagonal.assign(model.diagonal.begin(), model.diagonal.end());
  chain.upper.assign(model.upper.begin(), model.upper.end());
  int end = last + 1;
  while (end > first && on_surface[end - 1] != k)
    --end;
  int begin = end;
  while (begin > first && on_surface[begin - 1] == k)
    --begin;
  chain.begin = begin;
  chain.end = end;
  if (begin == end)
    return;
  for (int j = first; j < begin; ++j)
  {
    const double factor = chain.upper[j] / chain.diagonal[j];
    chain.diagonal[j + 1] -= factor * chain.upper[j];
    chain.gradient[j + 1] -= factor * chain.gradient[j];
  }
  for (int j = last; j >= end; --j)
  {
    const double factor = chain.upper[j - 1] / chain.diagonal[j];
    chain.diagonal[j - 1] -= factor * chain.upper[j - 1];
    chain.gradient[j - 1] -= factor * chain.gradient[j];
  }
  for (int j = begin; j < end; ++j)
  {
    surface.unknown[j] = 1;
    surface.gradient[j] = chain.gradient[j];
    surface.diagonal[j] = chain.diagonal[j];
    surface.upper[j] = j + 1 < end ? chain.upper[j] : 0.0;
  }
}

void LayerTwists::turn(int k, const Discretisation& layer, const TwistBoundary& boundary,
                       const std::vector<double>& turns, double share, State& state)
{
  Chain& chain = chain_[k];
  if (chain.begin == chain.end)
    return;
  chain.turns.assign(turns.begin(), turns.end());
  for (int j = chain.begin - 1; j >= twist_[k].firstUnknown(); --j)
    chain.turns[j] = -(chain.gradient[j] + chain.upper[j] * chain.turns[j + 1]) / chain.diagonal[j];
  for (int j = chain.end; j + 1 < layer.nodes(); ++j)
    chain.turns[j] = -(chain.gradient[j] + chain.upper[j - 1] * chain.turns[j - 1]) / chain.diagonal[j];
  LayerState& of_layer = state.layers[k];
  std::swap(state.twist_angle, of_layer.twist_angle);
  twist_[k].turn(layer, boundary, chain.turns, share, state);
  of_layer.hand_torque = state.hand_torque;
  std::swap(state.twist_angle, of_layer.twist_angle);
  const auto last = of_layer.twist_angle.begin() + (layer.nodes() - 2);
  std::fill(last + 1, of_layer.twist_angle.end(), *last);
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
