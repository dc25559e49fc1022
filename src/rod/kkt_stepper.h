#pragma once

#include <vector>

#include "rod/banded_ldlt.h"
#include "rod/bending_pair.h"
#include "rod/nodal_contacts.h"
#include "rod/sparse_solver.h"
#include "rod/stepper.h"
#include "rod/twist.h"
#include "rod/wall_friction.h"

namespace endovascular_sim::rod
{

/** The `kkt` scheme (docs/PHYSICS.md): backward Euler as one banded saddle system per solve.
 *
 *  Unknowns are interleaved x0, –, x1, λ0, x2, λ1, …: half bandwidth 10, every multiplier after both its nodes, so LDLᵀ
 *  needs no pivoting; the unknown that follows x0 stands for nothing and gives all nodes the same pattern.
 * Inextensibility is a constraint, bending Gauss–Newton, contact an active set of one-sided springs re-evaluated inside
 * the step, friction lagged in its normal force. A solve that would move a point further than its known free distance
 * is truncated, contacts are found again, and the same step is solved again. */
class KktStepper : public Stepper
{
public:
  KktStepper(Discretisation rod, Boundary boundary, Environment environment, StepperSettings settings);

  State initialState(double inserted_length, double rotation) const override;
  StepReport step(State& state, const StepInput& input, double dt, std::uint32_t& pass,
                  contact::ContactSource* contacts, PhaseTimer& timer) override;
  Energy energy(const State& state) override;
  const contact::ContactSet& contactSet() const override { return contacts_.set(); }
  void invalidateContacts() override { contacts_.invalidate(); }
  const Discretisation& discretisation() const override { return rod_; }
  bool resample(const Discretisation& rod) override;

  /** Gradient of the elastic energy at the nodes of a state whose twist has been relaxed [N]; for tests. */
  std::vector<Eigen::Vector3d> elasticGradient(State state, const StepInput& input);

private:
  static constexpr int kBandwidth = 10;
  using Matrix = BandedLdlt<kBandwidth, 4>;

  bool advance(State& state, const StepInput& input, double dt, int depth, StepReport& report);
  bool gainedEnergy(const State& state, int depth, double dt);
  void hold(State& state, int depth);
  bool solveStep(State& state, const StepInput& input, double dt, StepReport& report);
  bool restoreLengths(State& state, const StepInput& input, double dt, StepReport& report);
  void placePrescribedNodes(State& state, double inserted_length, double dt);
  void placeDistalEnd(State& state, const EndMotion& motion, double dt);
  bool isPrescribed(int node, const State& state) const;
  bool isDistalHeld(int node) const;
  static Eigen::Matrix3d distalRotation(const State& state);
  TwistBoundary twistBoundary(const State& state, const StepInput& input) const;
  void relaxTwist(State& state, const StepInput& input, const std::vector<TwistFriction>& friction);
  void collectFriction(const State& state, double dt, bool first_solve);

  void assemble(const State& state, const StepInput& input, double dt, bool first_solve);
  void addAllBending(const State& state, double dt);
  BendingPairInput bendingInput(int first, int second, const State& state, double dt) const;
  void addBending(int first, int second, const BendingPair& bending);
  void addConstraint(int edge, const State& state, double dt);
  void addMouth(const State& state, double dt);
  void addSheath(int edge, double share, const State& state, double dt);
  void addNodeTerms(int node, const State& state, double dt, bool first_solve);
  void addFriction(const WallFriction::Term& term, double dt);
  void addDiagonal(int node, double value);
  void addBlock(int node, const Eigen::Matrix3d& block);
  void prescribeNodes(const State& state);
  bool solveActiveSet(const State& state, double dt, StepReport& report);
  bool factoriseAndSolve(const State& state, StepReport& report);
  void addContact(const contact::Feature& feature, const NodalContacts::Spring& contact, double dt);
  double truncation(const State& state, StepReport& report);
  double move(State& state, double factor, StepReport& report);
  void accept(State& state, double dt);
  void updateEndForces(State& state, double dt) const;
  void updateHandParts(State& state, double dt);
  Eigen::Vector3d forceOnHold(int node, double dt) const;
  double heavyMass(int node) const;
  double foldTruncation(const State& state, double factor) const;
  double bodyPosition(int node, double inserted_length) const;
  void finish(State& state, double dt);

  int row(int node) const { return 4 * (node - first_); }
  int multiplierRow(int edge) const { return 4 * (edge - first_) + 7; }
  Eigen::Vector3d increment(int node) const
  {
    const double* value = rhs_.data() + row(node);
    return {value[0], value[1], value[2]};
  }

  Discretisation rod_;
  const Boundary boundary_;
  const Environment environment_;
  const StepperSettings settings_;
  double scale_;  ///< of the constraint rows [kg]

  QuasiStaticTwist twist_;
  bool twist_active_ = false;
  NodalContacts contacts_{rod_, boundary_, settings_};
  NodalContacts::Motion motion_;  ///< of the last solve, n
  WallFriction friction_{settings_.friction_slip};
  PhaseTimer* timer_ = nullptr;
  bool fading_ = true;   ///< the state may have offsets
  bool capped_ = false;  ///< the last step was accepted unfinished
  double strain_ = 0.0;  ///< largest of the last accepted iterate
  StepInput last_input_;

  int first_ = 0;  ///< first simulated node
  Matrix base_, matrix_;
  KluSolver klu_;
  std::vector<double> base_rhs_, rhs_;
  std::vector<Eigen::Vector3d> begin_;  ///< positions at the beginning of the step
  std::vector<double> begin_twist_;     ///< and twist angles
  std::vector<Eigen::Vector3d> slide_;  ///< motion of every node when the wire slides along itself
  std::vector<double> resistance_;      ///< of fluid and damping to a node's travel, times Δt² [kg]
  std::vector<Eigen::Vector3d> restore_begin_, restore_velocity_;
  std::vector<State> backup_;  ///< per depth of halving
};

}  // namespace endovascular_sim::rod
