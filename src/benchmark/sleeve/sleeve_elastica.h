#pragma once

#include <Eigen/Core>

namespace endovascular_sim::benchmark
{

/** Exact equilibria of a planar inextensible rod between a sliding sleeve and a pin on its axis (Bosi et al. 2015),
 *  with lengths over the distance L and forces over EI/L². Shooting for θ'' = H sin θ − V cos θ from the sleeve, along
 *  the branch of the first buckling mode. */
class SleeveElastica
{
public:
  static constexpr double kShortest = 1.01;  ///< first length of the branch that is computed

  SleeveElastica();

  /** Continues the branch to a length between sleeve and pin, not below kShortest.
   *  @throws std::runtime_error if the branch ends before */
  void moveTo(double length);

  /** Force that pushes the rod through the sleeve: −H less the configurational force ½κ² at the sleeve. */
  double handForce() const { return axialForce() - 0.5 * unknown_[0] * unknown_[0]; }

  /** Axial force −H in the rod. */
  double axialForce() const { return -unknown_[1]; }

  /** Bending energy over EI/L. */
  double energy() const;

private:
  bool solve(double length, const Eigen::Vector3d& guess);

  double length_ = 0.0;
  Eigen::Vector3d unknown_;    ///< curvature at the sleeve, H, V
  Eigen::Vector3d direction_;  ///< derivative of the unknowns by the length
};

}  // namespace endovascular_sim::benchmark
