#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/model/discretisation.h"

namespace endovascular_sim::rod
{

/** Fast projection (Goldenthal et al. 2007): moves the nodes to restore the rest length of every edge, along the
 *  gradients of the constraints and weighted with the inverse masses, which conserves linear momentum.
 *
 *  Constraints C_j = |e_j|² − ē_j². Every iteration substitutes δx = −Δt² M⁻¹ ∇Cᵀ δλ into C + ∇C δx = 0 and solves the
 *  tridiagonal system ∇C M⁻¹ ∇Cᵀ (Δt² δλ) = C. */
class FastProjection
{
public:
  /** Projects the positions of the nodes.
   *  @param rod of n nodes
   *  @param first first simulated node; the nodes before it do not move
   *  @param inverse_mass of every node, 0 for held ones [1/kg], n
   *  @param tolerance of | |e|/ē − 1 |
   *  @param position changed in place [m], n
   *  @return true when every edge that can move is within the tolerance */
  bool project(const Discretisation& rod, int first, const std::vector<double>& inverse_mass, double tolerance,
               std::vector<Eigen::Vector3d>& position);

  /** Tension of an edge over the last projection, times Δt² [kg·m]. */
  double tension(int edge) const { return tension_[edge]; }

  int iterations() const { return iterations_; }  ///< number of iterations of the last projection

private:
  double residual(const Discretisation& rod, int first, const std::vector<double>& inverse_mass,
                  const std::vector<Eigen::Vector3d>& position);
  bool solve(int first, int last, const std::vector<double>& inverse_mass);

  int iterations_ = 0;
  std::vector<Eigen::Vector3d> edge_;
  std::vector<double> constraint_, diagonal_, tension_;
};

}  // namespace endovascular_sim::rod
