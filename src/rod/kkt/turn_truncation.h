#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/model/discretisation.h"
#include "rod/model/state.h"

namespace endovascular_sim::rod
{

/** Share of a motion, 0 to 1, in which no edge rotates by more than @p max_rotation [rad] and no pair of neighbouring
 *  edges approaches a fold too far: 1 + cos of a sharp turning angle decreases by at most half. At a fold the bending
 *  energy is infinite, and beyond it the curvature binormal changes its side.
 *  @param motion increment of every node [m] */
double turnTruncation(const Discretisation& rod, const State& state, const std::vector<Eigen::Vector3d>& motion,
                      double max_rotation);

}  // namespace endovascular_sim::rod
