#pragma once

#include <vector>

#include "rod/boundary/boundary_conditions.h"
#include "rod/boundary/introducer_guide.h"
#include "rod/contact/contact_solver.h"
#include "rod/contact/wall_friction.h"
#include "rod/mixed/mixed_twist.h"
#include "rod/stepping/step_bisection.h"
#include "rod/stepping/stepper.h"

namespace endovascular_sim::rod
{

/** The `mixed` scheme: backward Euler for the fourth-order rod of mixed_rod.h, one banded quasi-definite system per
 *  solve with the exact second derivatives.
 *
 *  Inertia is nodal except at ends and at jumps of density or edge length. There Euler–Maclaurin's end term, written as
 * a convex combination of lumped and consistent mass, keeps it of fourth order (third at a jump). Weight acts through
 * the same matrix, so that a free wire falls without bending; other forces act at nodes. Contact is that of the chords
 *  (ContactSolver). A solve that would turn an edge too far is truncated, and the same step is solved again. A
 *  factorisation without the inertia of a minimum is shifted; if that fails, the step is bisected. */
class MixedStepper : public Stepper
{
public:
  /** @param wire of which @p rod is a discretisation; its sections should end at nodes */
  MixedStepper(const Wire& wire, Discretisation rod, Boundary boundary, Environment environment,
               StepperSettings settings);

  State initialState(double inserted_length, double rotation) const override;
  StepReport step(State& state, const StepInput& input, double dt, std::uint32_t& pass,
                  contact::ContactSource* contacts, PhaseTimer& timer) override;
  Energy energy(const State& state) override;
  const contact::ContactSet& contactSet() const override { return contacts_.set(); }
  void invalidateContacts() override { contacts_.invalidate(); }
  const Discretisation& discretisation() const override { return rod_; }

  /** Mass matrix: entry [i][0] is that of node i itself, [i][1] that between the nodes i and i + 1 [kg]. */
  const std::vector<std::array<double, 2>>& mass() const { return mass_; }
  const MixedRod& model() const { return model_; }

private:
  bool solveStep(State& state, const StepInput& input, double dt, StepReport& report);
  void placePrescribedNodes(State& state, double inserted_length, double dt);
  BoundaryConditions conditions() const { return {rod_, boundary_, ClampedNodes::kNode}; }

  void relaxTwist(State& state, double tip_torque);
  void assemble(const State& state, const StepInput& input, double dt, bool first_solve);
  void addInertia(const State& state, double dt);
  void addNodeTerms(int node, const State& state, double dt, bool first_solve);
  void addGuide(const State& state);
  void addBlock(const State& state, int node, const Eigen::Matrix3d& block);
  void addFriction(const State& state, const WallFriction::Term& term);
  void addSpring(const State& state, std::size_t index);
  bool solveActiveSet(const State& state, double dt, StepReport& report, bool& shifted);
  bool factoriseAndSolve(const State& state, double shift, StepReport& report);
  bool restoreLengths(State& state, const StepInput& input, double dt, StepReport& report);
  double truncation(const State& state, StepReport& report);
  void accept(State& state, double factor);
  double largestStrain(const State& state) const;
  void finish(State& state, double dt) const;
  Eigen::Vector3d increment(int row) const { return {rhs_[row], rhs_[row + 1], rhs_[row + 2]}; }

  const Discretisation rod_;
  const Boundary boundary_;
  const Environment environment_;
  const StepperSettings settings_;
  const IntroducerGuide guide_{boundary_};
  ContactSolver contacts_;
  WallFriction friction_{settings_.friction_slip};
  MixedRod model_;
  MixedTwist twist_;
  bool twist_active_ = false;
  double last_tip_torque_ = 0.0;
  std::vector<std::array<double, 2>> mass_;
  std::vector<Eigen::Vector3d> weight_;  ///< weight less buoyancy at every node [N]
  PhaseTimer* timer_ = nullptr;

  MixedRod::Matrix base_, matrix_;
  std::vector<double> gradient_, rhs_;
  ContactSolver::Motion motion_;        ///< increments of the nodes in the last solve [m]
  std::vector<Eigen::Vector3d> begin_;  ///< positions at the beginning of the step [m]
  std::vector<Eigen::Vector3d> restore_begin_, restore_velocity_;
  StepBisection bisection_;
};

}  // namespace endovascular_sim::rod
