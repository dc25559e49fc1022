#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "rod/linear/sparse_solver.h"
#include "rod/model/discretisation.h"

namespace endovascular_sim::benchmark
{

/** Constraint on one coordinate of a node, whose reaction is part of the solution. If it only removes a rigid-body
 * mode, the reaction is zero. */
struct Support
{
  int node = 0;
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< unit vector of the constrained coordinate
};

/** Potential of a node in space, with its derivatives by the node's position. */
struct NodePotential
{
  double energy = 0.0;                                 ///< [J]
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< [N]
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();   ///< [N/m]
};

/** Static problem of a discrete inextensible rod, open or a closed ring. */
struct EquilibriumProblem
{
  /** Rod of n nodes with n − 1 rest lengths, or n for a ring, whose last edge joins the last node to the first. */
  rod::Discretisation rod;
  std::vector<bool> held;                      ///< fixed nodes, two per clamp; size n
  std::vector<Support> supports;               ///< constraints on single coordinates
  std::vector<Eigen::Vector3d> force;          ///< dead loads, size n or empty [N]
  std::vector<Eigen::Vector3d> rest_binormal;  ///< rest curvature binormals, fixed in space, size n or empty [1]
  /** Potential of a node at a position [m], e.g. of a wall; empty: none. */
  std::function<NodePotential(int node, const Eigen::Vector3d& position)> node_potential;
  double tolerance = 1e-11;  ///< largest last motion over the length of the wire
  bool twist_held = false;   ///< prescribed twist; the torque is uniform, as in straight isotropic wires
  /** Twist between the material frames of both end edges relative to the direct parallel transport between them; for a
   *  ring, 2π times the linking number [rad]. */
  double twist = 0.0;

  int nodes() const { return rod.nodes(); }
  int edges() const { return static_cast<int>(rod.rest_length.size()); }
  bool closed() const { return edges() == nodes(); }
};

/** Closed ring of one section with equal edges; the nodes are the corners of a regular polygon. */
rod::Discretisation discretiseRing(const rod::Section& section, int nodes);

/** Initial guess and solution. */
struct Equilibrium
{
  std::vector<Eigen::Vector3d> position;  ///< positions of the nodes, size n [m]
  std::vector<double> tension;            ///< Lagrange multiplier of every edge [N]
  std::vector<double> reaction;           ///< reaction force of every support on the wire [N]
  double torque = 0.0;                    ///< uniform torque along the wire [N·m]
  double transport = 0.0;  ///< writhe contribution of the centreline to the twist, continuous over full turns [rad]
  int iterations = 0;
};

/** Static solver: Newton's method with the exact Hessian, multipliers for edges and supports, and KLU. It shares only
 * the energies with the time-stepping schemes. */
class EquilibriumSolver
{
public:
  /** @throws InputError for arrays of wrong size, or a prescribed twist without fixed ends */
  explicit EquilibriumSolver(EquilibriumProblem problem);

  const EquilibriumProblem& problem() const { return problem_; }
  EquilibriumProblem& problem() { return problem_; }

  /** Newton's method from the guess, regularised in proportion to the residual force.
   *  @return false without convergence; the guess is then overwritten */
  bool solve(Equilibrium& guess) const;

  /** Elastic energy minus the work of the dead loads [J]. */
  double potential(const Equilibrium& e) const;

  /** Gradient of the Lagrangian with respect to the nodes: zero at equilibrium, the reaction at fixed nodes; size 3n
   *  [N]. */
  Eigen::VectorXd forces(const Equilibrium& e) const;

  /** Exact Hessian of the Lagrangian with respect to the nodes at fixed tension and torque; 3n × 3n [N/m]. */
  rod::SparseMatrix hessian(const Equilibrium& e) const;

  /** Gradient of transport() with respect to the nodes; size 3n [rad/m]. */
  Eigen::VectorXd transportGradient(const Equilibrium& e) const;

  /** Writhe contribution of the centreline to the twist, on the branch nearest to e.transport [rad]. */
  double transport(const Equilibrium& e) const;

  /** Torsional compliance ∫ds/GJ between the centres of the end edges, or around the ring [1/(N·m)]. */
  double torsionalCompliance() const { return compliance_; }

  /** Eigenvalues of the second variation of the energy over all admissible motions, ascending [N/m]. The equilibrium is
   *  stable if none is negative. The computation is dense, for small rods. */
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
  double length_ = 0.0;  ///< length of the whole wire [m]
};

}  // namespace endovascular_sim::benchmark
