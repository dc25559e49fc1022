#pragma once

#include <vector>

#include "rod/mixed/mixed_twist.h"

namespace endovascular_sim::benchmark
{

struct StaticsSettings
{
  int load_steps = 1;         ///< equal steps from no load to all of it
  int max_iterations = 200;   ///< linear systems per load step
  double max_rotation = 0.4;  ///< of an edge in one iteration [rad]
  double tolerance = 1e-11;   ///< largest last motion of a node, of the wire's length
};

struct StaticsReport
{
  bool converged = false;
  int factorisations = 0;
  int shifts = 0;         ///< factorisations repeated with a larger shift because of a wrong inertia
  double residual = 0.0;  ///< largest out-of-balance force at a free node [N]
};

/** Brings a mixed rod to equilibrium: Newton with limited rotations on the exact second derivatives, and load
 *  continuation.
 *
 *  A small shift of the x block keeps LDLᵀ without pivoting usable; it grows while the number of negative pivots is not
 *  that of a stable equilibrium (a minimum in x), so the solution found is stable.
 *  @param rod edge loads and rest curvatures are scaled with the load during continuation and end as given
 *  @param forces on the nodes, in space [N]
 *  @param twist with it the rest curvature is that of the material frames, which are relaxed before every iteration;
 *    convergence is then linear, because second derivatives leave the frames' answer out
 *  @param state start (rod.straight(…), say) and result */
StaticsReport solveStatics(rod::MixedRod& rod, const std::vector<rod::NodalForce>& forces,
                           const StaticsSettings& settings, rod::State& state,
                           const rod::TwistBoundary* twist = nullptr);

}  // namespace endovascular_sim::benchmark
