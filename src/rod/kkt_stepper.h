#pragma once

#include <vector>

#include "rod/banded_ldlt.h"
#include "rod/bending_pair.h"
#include "rod/sparse_solver.h"
#include "rod/stepper.h"
#include "rod/twist.h"

namespace endovascular_sim::rod
{

/** Depth of a wire's surface up to which a soft wall gives way by its stiffness; from there on it is rigid [m]. The
 * wire's axis stays in the undeformed lumen. @param radius of the wire [m] */
double softWallTravel(double radius);

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
  const contact::ContactSet& contactSet() const override { return contacts_; }
  void invalidateContacts() override { contacts_valid_ = false; }
  const Discretisation& discretisation() const override { return rod_; }
  bool resample(const Discretisation& rod) override;

  /** Gradient of the elastic energy at the nodes of a state whose twist has been relaxed [N]; for tests. */
  std::vector<Eigen::Vector3d> elasticGradient(State state, const StepInput& input);

private:
  static constexpr int kBandwidth = 10;
  using Matrix = BandedLdlt<kBandwidth, 4>;

  /** A contact as the solver uses it. */
  struct ActiveContact
  {
    int node;        ///< the edge's first node
    double weight0;  ///< share of that node
    double weight1;  ///< share of the next one
    double stiffness;
    bool active;
  };

  bool advance(State& state, const StepInput& input, double dt, int depth, StepReport& report);
  void hold(State& state, int depth);
  bool solveStep(State& state, const StepInput& input, double dt, StepReport& report);
  bool restoreLengths(State& state, const StepInput& input, double dt, StepReport& report);
  void placePrescribedNodes(State& state, double inserted_length, double dt);
  void placeDistalEnd(State& state, const EndMotion& motion, double dt);
  bool isPrescribed(int node, const State& state) const;
  bool isDistalHeld(int node) const;
  static Eigen::Matrix3d distalRotation(const State& state);
  TwistBoundary twistBoundary(const State& state, const StepInput& input) const;
  void relaxTwist(State& state, const StepInput& input);

  void assemble(const State& state, const StepInput& input, double dt, bool first_solve);
  void addAllBending(const State& state, double dt);
  BendingPairInput bendingInput(int first, int second, const State& state, double dt) const;
  void addBending(int first, int second, const BendingPair& bending);
  void addConstraint(int edge, const State& state, double dt);
  void addNodeTerms(int node, const State& state, double dt, bool first_solve);
  void addFriction(int node, const State& state, const Eigen::Vector3d& travel, const Eigen::Vector3d& velocity,
                   double dt, Eigen::Vector3d& residual);
  void addDiagonal(int node, double value);
  void addBlock(int node, const Eigen::Matrix3d& block);
  void prescribeNodes(const State& state);
  bool solveActiveSet(const State& state, double dt, StepReport& report);
  bool factoriseAndSolve(const State& state, StepReport& report);
  void addContact(const contact::Feature& feature, const ActiveContact& contact, double dt);
  bool updateActiveSet(int active_pass);
  void prepareContacts(const State& state, double dt);
  double truncation(const State& state, StepReport& report);
  double move(State& state, double factor, StepReport& report);
  double deepest() const;
  void addBacking();
  void accept(State& state, double dt);
  void updateEndForces(State& state, double dt) const;
  Eigen::Vector3d forceOnHold(int node, double dt) const;
  void updateWallForces(State& state);
  double foldTruncation(const State& state, double factor) const;
  double freeDistanceTruncation(const State& state, StepReport& report);
  double staleTruncation();
  void detect(const State& state, StepReport& report);
  void ask(const State& state, bool want_free_distance, contact::ContactSet& answer, StepReport& report);
  bool foundUnknownContact() const;
  double contactMotion(std::size_t index) const;
  void moveToSampling(contact::Feature& feature, const Discretisation& rod) const;
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
  contact::ContactSet contacts_, previous_contacts_, free_distances_;
  bool step_is_stale_ = false;
  double stale_budget_ = 0.0;  ///< motion that the last fresh contact set still covers [m]
  bool contacts_valid_ = false;
  std::vector<ActiveContact> active_, previous_active_;
  contact::Query query_;
  contact::ContactSource* source_ = nullptr;
  PhaseTimer* timer_ = nullptr;
  std::uint32_t* pass_ = nullptr;
  std::uint64_t step_ = 0;
  std::uint32_t substep_ = 0;
  double strain_ = 0.0;  ///< largest of the last accepted iterate
  StepInput last_input_;

  int first_ = 0;  ///< first simulated node
  Matrix base_, matrix_;
  KluSolver klu_;
  std::vector<double> base_rhs_, rhs_;
  std::vector<Eigen::Vector3d> begin_;  ///< positions at the beginning of the step
  std::vector<Eigen::Vector3d> restore_begin_, restore_velocity_;
  std::vector<State> backup_;  ///< per depth of halving
};

}  // namespace endovascular_sim::rod
