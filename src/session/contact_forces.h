#pragma once

#include <vector>

#include <Eigen/Core>

#include "session/simulation.h"

namespace endovascular_sim::session
{

/** A place where the wall pushes on the wire. */
struct WallContact
{
  Eigen::Vector3d position = Eigen::Vector3d::Zero();        ///< on the wall [m]
  Eigen::Vector3d normal_force = Eigen::Vector3d::Zero();    ///< of the wall on the wire [N]
  Eigen::Vector3d friction_force = Eigen::Vector3d::Zero();  ///< of the wall on the wire [N]
  int triangle = 0;
};

/** The nodes that carry wall force after the last step, each with the wall feature nearest to it. */
std::vector<WallContact> wallContacts(const Simulation& simulation);

}  // namespace endovascular_sim::session
