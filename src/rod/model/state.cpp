#include "rod/model/state.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/hash.h"

namespace endovascular_sim::rod
{

EndMotion between(const EndMotion& from, const EndMotion& to, double share)
{
  return {from.displacement + share * (to.displacement - from.displacement), from.tilt + share * (to.tilt - from.tilt),
          from.rotation + share * (to.rotation - from.rotation)};
}

std::uint64_t State::hash() const
{
  // Four interleaved chains: each depends on its own last word only, so the processor runs them in parallel.
  std::array<Hash64, 4> chains;
  for (std::size_t i = static_cast<std::size_t>(first_node); i < position.size(); ++i)
  {
    for (int axis = 0; axis < 3; ++axis)
      chains[axis].add(position[i][axis]);
    if (i < twist_angle.size())
      chains[3].add(twist_angle[i]);
  }
  for (const LayerState& layer : layers)
    for (std::size_t j = static_cast<std::size_t>(first_node); j < layer.twist_angle.size(); ++j)
      chains[j % chains.size()].add(layer.twist_angle[j]);
  Hash64 hash;
  for (const Hash64& chain : chains)
    hash.add(chain.value());
  return hash.value();
}

HandleState handleState(const State& state, int instrument)
{
  if (state.layers.empty())
    return {state.inserted_length, state.rotation, state.hand_force, state.hand_torque};
  const LayerState& layer = state.layers[static_cast<std::size_t>(instrument)];
  return {layer.inserted_length, layer.rotation, layer.hand_force, layer.hand_torque};
}

double maxStrain(const Discretisation& rod, const State& state)
{
  double worst = 0.0;
  for (int j = state.first_node; j + 1 < rod.nodes(); ++j)
  {
    const double length = (state.position[j + 1] - state.position[j]).norm();
    worst = std::max(worst, std::abs(length / rod.rest_length[j] - 1.0));
  }
  return worst;
}

}  // namespace endovascular_sim::rod
