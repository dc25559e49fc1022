#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/contact/contact_solver.h"
#include "rod/contact/wall_friction.h"
#include "rod/kkt/kkt_model.h"
#include "rod/kkt/kkt_system.h"
#include "rod/linear/sparse_solver.h"
#include "rod/twist/surface_twist.h"

namespace endovascular_sim::rod
{

/** Layout of the positions and multipliers alone: that of KktSystem. */
struct PositionLayout
{
  static constexpr bool kTurns = false;
  static constexpr int kBandwidth = KktSystem::kBandwidth;
  static constexpr int kPeriod = 4;  ///< rows of a node
};

/** Layout with the turns of the edges as further unknowns: x0, –, ψ0, x1, λ0, ψ1, x2, λ1, ψ2, …. The turn ψ of an edge
 *  couples with the positions of its own nodes and of one further node on both sides. The block of positions and turns
 *  is positive definite: LDLᵀ needs no pivoting. */
struct TurnLayout
{
  static constexpr bool kTurns = true;
  static constexpr int kBandwidth = 12;
  static constexpr int kPeriod = 5;
};

/** Active-set solution of a `kkt` system with one-sided contact springs and wall friction.
 *
 *  With TurnLayout, friction acts on the sum of a node's motion and the motion of its surface by its turn, and the
 * twist resists the turns (SurfaceTwist). Positions and turns are one convex problem then.
 *
 *  A wire that rolls or slides about its axis on a concave wall swings like a pendulum of length ρ
 *  (Feature::clearance_radius). With the normal of the beginning of a solve, it would be explicit and unstable beyond
 *  Δt = 2√(m ρ/f_n). Therefore the system contains the rotation of the normal, (f_n/ρ) b bᵀ with b across the wire. */
template <class Layout>
class ActiveSetSolver
{
public:
  /** @param model, system must outlive this */
  ActiveSetSolver(const KktModel& model, const KktSystem& system) : model_(model), system_(system) {}

  /** Solves until the active set and the linearisation of friction are settled. A matrix whose inertia is not that of a
   *  minimum gets more mass.
   *  @param twist model of the twist; null without turns
   *  @param motion increment of every node [m]
   *  @return false when the system has no solution */
  bool solve(const State& state, double dt, ContactSolver& contacts, WallFriction& friction, const SurfaceTwist* twist,
             ContactSolver::Motion& motion, StepReport& report);

  /** Reduces the strain after a motion by a second right-hand side instead of another solve (second-order correction:
   *  Nocedal & Wright 2006, §18.3). A motion stretches the edges by the square of their rotation. The remainder is of
   *  higher order. Larger strains are left to the next solve. */
  void correctLengths(const State& state, ContactSolver::Motion& motion);

  /** Solution of the system in the order of KktSystem: the nodes' increments [m] and the edges' multipliers. */
  const std::vector<double>& solution() const { return Layout::kTurns ? solution_ : rhs_; }

  /** Turn of every edge [rad]; zero where it is not an unknown. */
  const std::vector<double>& turns() const { return turn_; }

private:
  using Matrix = BandedLdlt<Layout::kBandwidth, Layout::kPeriod>;

  int row(int node) const { return Layout::kPeriod * (node - system_.first); }
  int multiplierRow(int edge) const { return row(edge + 1) + 3; }
  int turnRow(int edge) const { return row(edge) + 4; }

  void buildBase(const SurfaceTwist& twist, double dt, bool coupled);
  void spreadSystem();
  void addTwist(const SurfaceTwist& twist, double dt);
  void addMixedDerivatives(const SurfaceTwist& twist, double dt);
  void addEdgeStiffness(const SurfaceTwist& twist, double dt);
  void addBlock(int row_node, int column_node, const Eigen::Matrix3d& block);
  bool updateFriction(WallFriction& friction, const ContactSolver::Motion& motion, int pass);
  bool factoriseAndSolve(const State& state, StepReport& report);
  void solveWithFactors(std::vector<double>& rhs);
  void prescribeNodes(const State& state);
  void addTerms(const ContactSolver& contacts, const WallFriction& friction, double shift, double dt);
  void addContact(const contact::Feature& feature, const ContactSolver::Spring& contact, double dt);
  void addCurvature(const contact::Feature& feature, const ContactSolver::Spring& contact, double dt);
  void addFriction(const WallFriction::Term& term, double dt);
  void addFrictionAboutAxis(const WallFriction::Term& term, double dt);
  void addEntry(int a, int b, double value);
  bool canRewind(const State& state) const;
  bool isSmall() const;
  void readMotion(ContactSolver::Motion& motion);
  void readTurns();

  const KktModel& model_;
  const KktSystem& system_;
  const SurfaceTwist* twist_ = nullptr;
  const State* state_ = nullptr;  ///< of the present solve
  Matrix base_;  ///< TurnLayout: the system and the twist, without contacts, friction and prescribed nodes
  std::vector<double> base_rhs_;
  Matrix matrix_;
  int fresh_ = 0;  ///< first column of the matrix that holds nothing but the system's entries
  KluSolver klu_;
  std::vector<double> rhs_;
  std::vector<double> correction_;
  std::vector<double> solution_;
  std::vector<double> turn_;       ///< per edge [rad]
  std::vector<double> node_turn_;  ///< per node [rad]
};

extern template class ActiveSetSolver<PositionLayout>;
extern template class ActiveSetSolver<TurnLayout>;

}  // namespace endovascular_sim::rod
