#pragma once

#include "rod/model/bending.h"
#include "rod/model/discretisation.h"
#include "rod/model/state.h"

namespace endovascular_sim::rod
{

/** Curvature binormal of a wire at a node between two simulated edges. */
inline CurvatureBinormal binormalAt(const Discretisation& rod, const State& state, int node)
{
  return {state.position[node] - state.position[node - 1], state.position[node + 1] - state.position[node],
          rod.rest_length[node - 1] * rod.rest_length[node]};
}

}  // namespace endovascular_sim::rod
