#pragma once

#include <vector>

#include <Eigen/Core>

#include "rod/contact/contact_solver.h"
#include "rod/contact/wall_friction.h"
#include "rod/kkt/kkt_model.h"
#include "rod/kkt/kkt_system.h"
#include "rod/linear/sparse_solver.h"

namespace endovascular_sim::rod
{

/** Active-set solution of a `kkt` system with one-sided contact springs and wall friction. */
class ActiveSetSolver
{
public:
  /** @param model, system must outlive this */
  ActiveSetSolver(const KktModel& model, const KktSystem& system) : model_(model), system_(system) {}

  /** Solves until the active set and the linearisation of friction are settled. A matrix whose inertia is not that of a
   *  minimum gets more mass.
   *  @param motion increment of every node [m]
   *  @return false when the system has no solution */
  bool solve(const State& state, double dt, ContactSolver& contacts, WallFriction& friction,
             ContactSolver::Motion& motion, StepReport& report);

  /** Reduces the strain after a motion by a second right-hand side instead of another solve (second-order correction:
   *  Nocedal & Wright 2006, §18.3). A motion stretches the edges by the square of their rotation. The remainder is of
   *  higher order. Larger strains are left to the next solve. */
  void correctLengths(const State& state, ContactSolver::Motion& motion);

  /** Solution of the system: the nodes' increments [m] and the edges' multipliers. */
  const std::vector<double>& solution() const { return rhs_; }

private:
  bool factoriseAndSolve(const State& state, StepReport& report);
  void solveWithFactors(std::vector<double>& rhs);
  void prescribeNodes(const State& state);
  void addTerms(const ContactSolver& contacts, const WallFriction& friction, double shift, double dt);
  void addContact(const contact::Feature& feature, const ContactSolver::Spring& contact, double dt);
  void addFriction(const WallFriction::Term& term, double dt);
  bool canRewind(const State& state) const;
  bool isSmall() const;
  void readMotion(ContactSolver::Motion& motion) const;

  const KktModel& model_;
  const KktSystem& system_;
  KktSystem::Matrix matrix_;
  int fresh_ = 0;  ///< first column of the matrix that holds nothing but the system's entries
  KluSolver klu_;
  std::vector<double> rhs_;
  std::vector<double> correction_;
};

}  // namespace endovascular_sim::rod
