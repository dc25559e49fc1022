#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::phantom
{

/** Function of a point whose negative values are the inside of a solid. The Lipschitz constant is at most 1 [m]. */
using Solid = std::function<double(const Eigen::Vector3d&)>;

Solid ball(const Eigen::Vector3d& centre, double radius);

/** Ellipsoid with axes parallel to those of the frame: (‖q‖ − 1)·r with q the scaled point and r the shortest
 * semi-axis.
 *  @param semi_axes [m] */
Solid ellipsoid(const Eigen::Vector3d& centre, const Eigen::Vector3d& semi_axes);

/** Chain of balls: a tube through points. */
Solid ballChain(std::vector<Eigen::Vector3d> centres, double radius);

}  // namespace endovascular_sim::phantom
