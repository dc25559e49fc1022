#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "simulation/simulation.h"

namespace endovascular_sim::simulation
{

/** Contact of one node with the wall. */
struct WallContact
{
  static constexpr std::size_t kMostFacets = 6;

  Eigen::Vector3d position = Eigen::Vector3d::Zero();      ///< point on the wall [m]
  Eigen::Vector3d normal_force = Eigen::Vector3d::Zero();  ///< force of the wall on the wire [N]
  /** The normal force in the vessel at rest: of equal magnitude, and along the normal there [N]. */
  Eigen::Vector3d resting_force = Eigen::Vector3d::Zero();
  Eigen::Vector3d friction_force = Eigen::Vector3d::Zero();  ///< force of the wall on the wire [N]
  int node = 0;                                              ///< node of the wire
  double gap = 0.0;   ///< distance of the wire's surface from the wall; infinite without a feature at the node [m]
  int triangle = -1;  ///< triangle of the nearest feature; −1 without a feature at the node
  /** Triangles of the features that may carry the force, the deepest first; −1 ends them. */
  std::array<int, kMostFacets> touched = {-1, -1, -1, -1, -1, -1};
};

/** Friction force of the wall on a node after the last step [N]. */
Eigen::Vector3d wallFriction(const Simulation& simulation, int node);

/** Nodes with wall force after the last step, in their order, each with the nearest wall feature. Features on the
 *  node's own halves of its edges take precedence over those on the far halves. */
void wallContacts(const Simulation& simulation, std::vector<WallContact>& contacts);
std::vector<WallContact> wallContacts(const Simulation& simulation);

}  // namespace endovascular_sim::simulation
