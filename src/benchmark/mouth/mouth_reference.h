#pragma once

#include <vector>

#include "benchmark/reference/equilibrium.h"
#include "rod/model/wire.h"

namespace endovascular_sim::benchmark
{

/** Plane problem of a wire that is pushed out of the introducer into a frictionless tube. */
struct MouthProblem
{
  rod::Wire wire;                 ///< rest curvatures with a second component only, instrument::arcCurvature(r, 0)
  double guide_length = 19e-3;    ///< of the introducer before its mouth [m]
  double guide_decay = 3e-3;      ///< λ of the guide's potential [m]
  double sheath_clearance = 0.0;  ///< largest lateral offset in the introducer [m]
  double clearance = 0.0;         ///< largest distance between the axes of wire and tube [m]
  double bend_begin = 0.0;        ///< straight length of the tube [m]
  double bend_curvature = 0.0;    ///< of the tube beyond, to the side of the rest curvature [1/m]; 0: straight
  double edge = 0.1e-3;           ///< length of an edge [m]
};

/** Quasi-static force on the hand: the derivative of the least energy by the inserted length.
 *
 *  It is independent of the time-stepping schemes: equilibria by EquilibriumSolver on fine edges, the energy of rest
 *  curvature by the midpoint rule on the same edges, and the force by central differences of the least energy. In
 * common are the continuous potentials of the introducer (docs/PHYSICS.md, "Introducer"). */
class MouthReference
{
public:
  explicit MouthReference(MouthProblem problem) : problem_(std::move(problem)) {}

  /** Force on the hand at an inserted length [N]. Equilibria are followed: call it with lengths in small steps.
   *  @throws std::runtime_error without an equilibrium */
  double force(double inserted_length);

private:
  EquilibriumProblem problemAt(double inserted_length) const;
  Eigen::Vector3d slid(double edges, const Eigen::Vector3d& straight) const;
  double leastEnergy(double inserted_length);
  NodePotential potentialAt(const Eigen::Vector3d& position, double stiffness, double length, bool tip) const;
  void addWall(const Eigen::Vector3d& position, double length, NodePotential& sum) const;
  int simulatedEdges(double inserted_length) const;

  MouthProblem problem_;
  std::vector<Eigen::Vector3d> last_;  ///< positions of the last equilibrium, from the tip backwards [m]
  double last_insertion_ = 0.0;
  int edges_ = 0;  ///< simulated edges of the present pair of equilibria
};

}  // namespace endovascular_sim::benchmark
