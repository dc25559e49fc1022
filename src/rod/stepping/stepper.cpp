#include "rod/stepping/stepper.h"

#include <algorithm>

#include "rod/stepping/step_bisection.h"

namespace endovascular_sim::rod
{

void StepReport::add(const StepReport& other)
{
  solved = solved && other.solved;
  solves += other.solves;
  factorisations += other.factorisations;
  truncations += other.truncations;
  bisections += other.bisections;
  hit_iteration_limit += other.hit_iteration_limit;
  max_strain = std::max(max_strain, other.max_strain);
  first_stale_pass = std::min(first_stale_pass, other.first_stale_pass);
}

void StepInput::setHandles(const std::vector<LayerInput>& handles)
{
  if (handles.size() > 1)
  {
    layers = handles;
    return;
  }
  inserted_length = handles.front().inserted_length;
  rotation = handles.front().rotation;
}

State Stepper::initialState(const std::vector<LayerInput>& layers) const
{
  if (layers.size() != 1)
    throw std::invalid_argument("Stepper: this scheme simulates one instrument");
  return initialState(layers.front().inserted_length, layers.front().rotation);
}

StepInput firstHalf(const State& state, const StepInput& input)
{
  StepInput half = input;
  half.inserted_length = 0.5 * (state.inserted_length + input.inserted_length);
  half.rotation = 0.5 * (state.rotation + input.rotation);
  half.distal = between(state.distal, input.distal, 0.5);
  half.wall_to = 0.5 * (input.wall_from + input.wall_to);
  for (std::size_t k = 0; k < half.layers.size(); ++k)
  {
    half.layers[k].inserted_length = 0.5 * (state.layers[k].inserted_length + input.layers[k].inserted_length);
    half.layers[k].rotation = 0.5 * (state.layers[k].rotation + input.layers[k].rotation);
  }
  return half;
}

StepInput secondHalf(const StepInput& half, const StepInput& input)
{
  StepInput second = input;
  second.wall_from = half.wall_to;
  return second;
}

}  // namespace endovascular_sim::rod
