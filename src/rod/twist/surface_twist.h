#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

namespace endovascular_sim::rod
{

/** Quadratic model of the twist energy by the turns of the edges of the outer surface, at fixed centreline and without
 *  friction of the wall. A turn is the increment of an edge's twist angle in a solve. The Hessian is tridiagonal and
 *  positive definite. */
struct SurfaceTwist
{
  /** Second derivatives of the energy by the edges before and after a node, beyond those of the Gauss–Newton method
   *  [N/m]. */
  struct EdgeStiffness
  {
    Eigen::Matrix3d before = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d across = Eigen::Matrix3d::Zero();  ///< rows of the edge before, columns of that after
    Eigen::Matrix3d after = Eigen::Matrix3d::Zero();
  };

  /** Mixed derivatives of the energy by the turn of an edge and by the positions of the node before it, both its own
   *  nodes, and the node after it [N]. */
  using MixedDerivatives = std::array<Eigen::Vector3d, 4>;

  /** Sets the number of edges, all without an unknown turn. */
  void reset(std::size_t edges)
  {
    unknown.assign(edges, 0);
    gradient.assign(edges, 0.0);
    diagonal.assign(edges, 0.0);
    upper.assign(edges, 0.0);
    weight.assign(edges + 1, {0.0, 0.0});
    mixed.clear();
  }

  std::vector<char> unknown;                  ///< 0: the edge does not turn beyond the prediction
  std::vector<double> gradient;               ///< by the turn of every edge [N·m]
  std::vector<double> diagonal;               ///< Hessian of every edge [N·m/rad]
  std::vector<double> upper;                  ///< Hessian of every edge and the next one [N·m/rad]
  std::vector<std::array<double, 2>> weight;  ///< turn of every node: weights of the edges before and after it
  std::vector<MixedDerivatives> mixed;        ///< per edge; empty: turns and positions are not coupled
  std::vector<EdgeStiffness> stiffness;       ///< per node with two simulated edges; where mixed is not empty
};

}  // namespace endovascular_sim::rod
