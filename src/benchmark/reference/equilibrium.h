#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/linear/sparse_solver.h"
#include "rod/model/discretisation.h"

namespace endovascular_sim::benchmark
{

/** One coordinate of a node that stays as it is; its reaction is part of the solution. It also takes away a rigid
 *  motion that nothing else holds: the reaction is then zero. */
struct Support
{
  int node = 0;
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< unit
};

/** A discrete rod of inextensible edges at rest, open or a closed ring. */
struct EquilibriumProblem
{
  /** n nodes; n − 1 rest lengths, or n for a ring, whose last edge joins the last node to the first. */
  rod::Discretisation rod;
  std::vector<bool> held;                      ///< nodes whose position stays; a clamp holds two. n
  std::vector<Support> supports;               ///< further single coordinates
  std::vector<Eigen::Vector3d> force;          ///< dead loads, n or empty [N]
  std::vector<Eigen::Vector3d> rest_binormal;  ///< rest curvature binormal, fixed in space, n or empty [1]
  /** Twist between the material frames of both end edges, measured against the direct parallel transport between
   *  them; of a ring, 2π times its linking number. Uniform torque: for straight isotropic wires. */
  bool twist_held = false;
  double twist = 0.0;  ///< [rad]

  int nodes() const { return rod.nodes(); }
  int edges() const { return static_cast<int>(rod.rest_length.size()); }
  bool closed() const { return edges() == nodes(); }
};

/** A closed ring of one section, cut into equal edges, its nodes at the corners of a regular polygon. */
rod::Discretisation discretiseRing(const rod::Section& section, int nodes);

/** A guess, then a solution. */
struct Equilibrium
{
  std::vector<Eigen::Vector3d> position;  ///< [m], n
  std::vector<double> tension;            ///< multiplier of every edge [N]
  std::vector<double> reaction;           ///< of every support, on the wire [N]
  double torque = 0.0;                    ///< along the wire [N·m]
  double transport = 0.0;  ///< twist that the centreline adds, followed over full turns from the value before [rad]
  int iterations = 0;
};

/** Solves for the rest shape by Newton's method with the exact Hessian, multipliers for edges and supports, and KLU:
 *  independent of the time-stepping schemes, which share only the energies with it. */
class EquilibriumSolver
{
public:
  /** @throws InputError for arrays of wrong size, or a twist whose ends are not held */
  explicit EquilibriumSolver(EquilibriumProblem problem);

  const EquilibriumProblem& problem() const { return problem_; }
  EquilibriumProblem& problem() { return problem_; }

  /** Newton's method from the guess, regularised in proportion to the residual force.
   *  @return false when it does not converge; the guess is then spoilt */
  bool solve(Equilibrium& guess) const;

  /** Elastic energy less the work of the dead loads [J]. */
  double potential(const Equilibrium& e) const;

  /** Gradient of the potential by the nodes, with the edges' tensions: zero at equilibrium, the force of the hold at
   *  held nodes [N], 3n. */
  Eigen::VectorXd forces(const Equilibrium& e) const;

  /** Exact second derivative of the Lagrangian by the nodes at fixed tension and torque [N/m], 3n × 3n. */
  rod::SparseMatrix hessian(const Equilibrium& e) const;

  /** Derivative of the transport by the nodes [rad/m], 3n. */
  Eigen::VectorXd transportGradient(const Equilibrium& e) const;

  /** Twist that the centreline adds, nearest to e.transport [rad]. */
  double transport(const Equilibrium& e) const;

  /** ∫ds/GJ between the middles of the end edges, or around the ring [1/(N·m)]. */
  double torsionalCompliance() const { return compliance_; }

  /** Eigenvalues, ascending, of the energy's second variation over all motions that keep edges and supports [N/m]: the
   *  equilibrium is stable when none is negative. Dense: for small rods. */
  Eigen::VectorXd stiffness(const Equilibrium& e) const;

private:
  struct Edge
  {
    Eigen::Vector3d vector;
    double length;
  };
  using Triplets = std::vector<Eigen::Triplet<double>>;

  static Eigen::Index rowOf(int node) { return Eigen::Index{3} * node; }
  int next(int node) const { return node + 1 < problem_.nodes() ? node + 1 : 0; }
  int previous(int node) const { return node > 0 ? node - 1 : problem_.nodes() - 1; }
  int edgeBefore(int node) const { return node > 0 ? node - 1 : problem_.edges() - 1; }
  int firstBent() const { return problem_.closed() ? 0 : 1; }
  int lastBent() const { return problem_.closed() ? problem_.nodes() - 1 : problem_.nodes() - 2; }
  bool rigidEdge(int edge) const { return problem_.held[edge] && problem_.held[next(edge)]; }
  Edge edge(const Equilibrium& e, int index) const;
  Eigen::Vector3d restBinormal(int node) const;
  Eigen::VectorXd residual(const Equilibrium& e) const;
  rod::SparseMatrix saddle(const Equilibrium& e, double shift) const;
  void addConstraints(const Equilibrium& e, Triplets& entries) const;
  void advance(Equilibrium& e, const Eigen::VectorXd& step) const;
  Eigen::MatrixXd constraintJacobian(const Equilibrium& e) const;

  int unknowns() const;

  EquilibriumProblem problem_;
  double compliance_ = 0.0;
  double length_ = 0.0;  ///< of the whole wire [m]
};

}  // namespace endovascular_sim::benchmark
