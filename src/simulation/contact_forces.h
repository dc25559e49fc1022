#pragma once

#include <vector>

#include <Eigen/Core>

#include "simulation/simulation.h"

namespace endovascular_sim::simulation
{

/** A place where the wall pushes on the wire. */
struct WallContact
{
  Eigen::Vector3d position = Eigen::Vector3d::Zero();        ///< on the wall [m]
  Eigen::Vector3d normal_force = Eigen::Vector3d::Zero();    ///< of the wall on the wire [N]
  Eigen::Vector3d friction_force = Eigen::Vector3d::Zero();  ///< of the wall on the wire [N]
  int node = 0;                                              ///< of the wire
  double gap = 0.0;                                          ///< wire's surface to wall there; infinite: not listed [m]
  int triangle = -1;                                         ///< −1: the contact set lists nothing at the node
};

/** The nodes that carry wall force after the last step, in their order, each with the wall feature nearest to it,
 *  of those beside it before those towards the next nodes.
 *  Without allocation once @p contacts has room for them. */
void wallContacts(const Simulation& simulation, std::vector<WallContact>& contacts);
std::vector<WallContact> wallContacts(const Simulation& simulation);

}  // namespace endovascular_sim::simulation
