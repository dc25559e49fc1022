#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/model/discretisation.h"
#include "rod/model/state.h"

namespace endovascular_sim::rod
{

/** Share of a motion, 0 to 1, in which no edge turns by more than @p max_rotation [rad] and no two neighbouring edges
 *  come closer to folding back onto each other than by half of what is left: the bending energy is infinite at a fold,
 *  and beyond it the curvature binormal has changed its side.
 *  @param motion increment of every node [m] */
double turnTruncation(const Discretisation& rod, const State& state, const std::vector<Eigen::Vector3d>& motion,
                      double max_rotation);

}  // namespace endovascular_sim::rod
