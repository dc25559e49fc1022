#pragma once

#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::rod
{

/** Computes the velocity of every node when the wire slides along itself by a unit of length: d·w = 1 on both edges of
 * a node. No edge changes its length, so that tensions do no work. Held nodes move along @p direction.
 *  @param position after the last solve [m]
 *  @param motion of the last solve [m]; the equations of that solve contain the edges' directions before it
 *  @param first node of the simulated part
 *  @param held last node that the proximal end holds; first − 1: none
 *  @param slide velocities of all nodes from @p first on [1] */
void slideAlongItself(const std::vector<Eigen::Vector3d>& position, const std::vector<Eigen::Vector3d>& motion,
                      int first, int held, const Eigen::Vector3d& direction, std::vector<Eigen::Vector3d>& slide);

}  // namespace endovascular_sim::rod
