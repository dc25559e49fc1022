#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "rod/discretisation.h"

namespace endovascular_sim::rod
{

/** What changes from step to step. Arrays run over all nodes (n) or edges (n−1) of the wire; those before
 *  first_node lie outside the introducer, straight and unsimulated. */
struct State
{
  int first_node = 0;
  double inserted_length = 0.0;              ///< wire beyond the introducer [m]
  double rotation = 0.0;                     ///< of the handle [rad]
  std::vector<Eigen::Vector3d> position;     ///< [m], n
  std::vector<Eigen::Vector3d> velocity;     ///< [m/s], n
  std::vector<double> tension;               ///< multiplier of inextensibility [N], n−1
  std::vector<Eigen::Vector3d> moment;       ///< bending moment in space, schemes that solve for it only [N·m], n
  std::vector<double> twist_angle;           ///< material frame against Bishop frame [rad], n−1
  std::vector<Eigen::Vector3d> wall_force;   ///< normal force of the wall on each node [N], n
  std::vector<double> friction_coefficient;  ///< of the contact that pushes on each node, n
  double hand_force = 0.0;                   ///< axial force of the wire on the hand, positive when it pushes back [N]
  double hand_torque = 0.0;                  ///< torque that the hand holds about the wire's axis [N·m]

  /** 64-bit hash over the positions and twist angles from first_node on, as IEEE-754 bytes. */
  std::uint64_t hash() const;
};

/** Elastic energies of the simulated part of the wire [J]. */
struct Energy
{
  double bending = 0.0;
  double twist = 0.0;
  double stretch = 0.0;
};

/** Largest | |e|/|ē| − 1 | over the simulated edges. */
double maxStrain(const Discretisation& rod, const State& state);

}  // namespace endovascular_sim::rod
