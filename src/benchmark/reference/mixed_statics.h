#pragma once

#include <vector>

#include "rod/mixed/mixed_twist.h"

namespace endovascular_sim::benchmark
{

/** Settings of solveStatics(). */
struct StaticsSettings
{
  int load_steps = 1;         ///< equal load increments
  int max_iterations = 200;   ///< linear systems per load increment
  double max_rotation = 0.4;  ///< largest rotation of an edge in one iteration [rad]
  double tolerance = 1e-11;   ///< largest last motion of a node over the length of the wire
};

/** Result of solveStatics(). */
struct StaticsReport
{
  bool converged = false;
  int factorisations = 0;
  int shifts = 0;         ///< factorisations repeated with a larger shift after a wrong inertia
  double residual = 0.0;  ///< largest out-of-balance force at a free node [N]
};

/** Static solver of a mixed rod: Newton's method with exact second derivatives, limited rotations and load
 * continuation.
 *
 *  A small shift of the x block permits LDLᵀ without pivoting. The shift increases while the number of negative pivots
 *  differs from that of a stable equilibrium (a minimum in x), so the solution is stable.
 *  @param rod edge loads and rest curvatures are scaled during continuation and restored at the end
 *  @param forces forces on the nodes, fixed in space [N]
 *  @param twist if given, the rest curvature refers to the material frames, which are relaxed before every iteration;
 *    convergence is then linear, because the second derivatives exclude the response of the frames
 *  @param state initial state, e.g. rod.straight(…), and result */
StaticsReport solveStatics(rod::MixedRod& rod, const std::vector<rod::NodalForce>& forces,
                           const StaticsSettings& settings, rod::State& state,
                           const rod::TwistBoundary* twist = nullptr);

}  // namespace endovascular_sim::benchmark
