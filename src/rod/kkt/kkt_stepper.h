#pragma once

#include <vector>

#include "rod/contact/contact_solver.h"
#include "rod/contact/wall_friction.h"
#include "rod/linear/banded_ldlt.h"
#include "rod/linear/sparse_solver.h"
#include "rod/model/bending_pair.h"
#include "rod/stepping/stepper.h"
#include "rod/twist/twist.h"

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
  void setContactRadii(const std::vector<double>& radii) override { contacts_.setRadii(radii); }
  void invalidateContacts() override { contacts_.invalidate(); }
  const Discretisation& discretisation() const override { return rod_; }
  bool resample(const Discretisation& rod) override;
  void archive(Archive& archive, const State& state) override;

  /** Gradient of the elastic energy at the nodes of a state whose twist has been relaxed [N]; for tests. */
  std::vector<Eigen::Vector3d> elasticGradient(State state, const StepInput& input);

protected:
  // What a stack of several instruments does in another way (StackStepper).

  /** What the twist does to the centreline. */
  struct TwistAction
  {
    bool active = false;
    int first_curved = 0;                            ///< first node with rest curvature
    const Eigen::Vector3d* rest_binormal = nullptr;  ///< per node from first_curved on [1]
    const double* torque = nullptr;                  ///< per node, or of all layers together [N·m]
  };

  /** How a node's mass moves along the wire beside the node itself, where layers slide over the nodes. */
  struct MassSlide
  {
    Eigen::Vector3d travel = Eigen::Vector3d::Zero();  ///< in the step [m]
    Eigen::Vector3d gained = Eigen::Vector3d::Zero();  ///< less what it would be at the speed of the last step [m]
  };

  /** A step, once the contacts have been told of it. */
  virtual bool run(State& state, const StepInput& input, double dt, StepReport& report);
  /** Sets the rod's properties for the end of a step (or a part of one). */
  virtual void refreshRod(State& state, const StepInput& input, double dt);
  /** Brings the twist to rest for the present centreline.
   *  @param friction of the wall about the axis */
  virtual TwistAction relaxTwist(State& state, const StepInput& input, const std::vector<TwistFriction>& friction);
  /** Angle of the surface at every node [rad], n. */
  virtual void surfaceAngles(const State& state, std::vector<double>& angle) const;
  /** The same at the beginning of the step. */
  virtual void surfaceBeginAngles(const State& state, std::vector<double>& angle) const;
  /** Whether a step turns a hand. */
  virtual bool turns(const State& state, const StepInput& input) const { return state.rotation != input.rotation; }
  /** Sets the torques at the ends to those of the centreline as it is now; nothing else changes. */
  virtual void renewTorques(State& state, const StepInput& input);
  /** After a step that was solved. */
  virtual void complete(State& state, double dt);
  /** Largest work that the hands may have done between two states [J]. */
  virtual double handWork(const State& before, const State& after) const;
  /** Motion of the surface over the nodes in the step; null: none. */
  virtual const std::vector<Eigen::Vector3d>* surfaceSlide() const { return nullptr; }

  /** Motion of the nodes' masses; null: with the nodes. */
  virtual const std::vector<MassSlide>* massSlide() const { return nullptr; }

  bool advance(State& state, const StepInput& input, double dt, int depth, StepReport& report);
  /** Drag of the fluid on a node per speed of its surface [N·s/m]; outside of the body 0. */
  double dragCoefficient(int node, double speed, const State& state) const;
  TwistBoundary twistBoundary(const State& state, const StepInput& input) const;
  /** Friction about the axis of a state that goes on from where it is. */
  const std::vector<TwistFriction>& frictionAtRest(const State& state);
  const Boundary& boundary() const { return boundary_; }
  const Environment& environment() const { return environment_; }
  const StepperSettings& settings() const { return settings_; }
  /** To be used with another input or model until the next step. */
  void useTimer(PhaseTimer& timer) { timer_ = &timer; }
  const std::vector<TwistFriction>& frictionAboutAxis() const { return friction_.lastAboutAxis(); }
  const StepInput& lastInput() const { return last_input_; }
  Discretisation& rod() { return rod_; }
  const Discretisation& rod() const { return rod_; }

private:
  static constexpr int kBandwidth = 10;
  using Matrix = BandedLdlt<kBandwidth, 4>;

  bool gainedEnergy(const State& state, int depth, double dt);
  void hold(State& state, int depth);
  bool solveStep(State& state, const StepInput& input, double dt, StepReport& report);
  bool restoreLengths(State& state, const StepInput& input, double dt, StepReport& report);
  void placePrescribedNodes(State& state, double inserted_length, double dt);
  void placeDistalEnd(State& state, const EndMotion& motion, double dt);
  bool isPrescribed(int node, const State& state) const;
  int firstFreeNode(const State& state) const;
  bool isDistalHeld(int node) const;
  static Eigen::Matrix3d distalRotation(const State& state);
  SurfaceMotion surfaceMotion() const;
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
  bool canRewind(const State& state) const;
  bool factoriseAndSolve(const State& state, StepReport& report);
  void solveAgain(std::vector<double>& rhs);
  void correctLengths(const State& state);
  void addContact(const contact::Feature& feature, const ContactSolver::Spring& contact, double dt);
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
  TwistAction action_;
  ContactSolver contacts_{rod_, boundary_, settings_};
  ContactSolver::Motion motion_;  ///< of the last solve, n
  WallFriction friction_{settings_.friction_slip};
  PhaseTimer* timer_ = nullptr;
  bool fading_ = true;                ///< the state may have offsets
  bool hit_iteration_limit_ = false;  ///< the last step was accepted unfinished
  bool restoring_ = false;            ///< lengths, from rest
  double strain_ = 0.0;               ///< largest of the last accepted iterate
  StepInput last_input_;

  int first_ = 0;  ///< first simulated node
  Matrix base_, matrix_;
  int fresh_ = 0;  ///< first column of the matrix that holds nothing but the base
  KluSolver klu_;
  std::vector<double> base_rhs_, rhs_;
  std::vector<double> correction_;      ///< of the solution
  std::vector<Eigen::Vector3d> begin_;  ///< positions at the beginning of the step
  std::vector<double> begin_twist_;     ///< and twist angles
  std::vector<double> kept_twist_;
  std::vector<double> surface_begin_, surface_angle_;  ///< of the surface at every node, at the beginning and now
  std::vector<Eigen::Vector3d> slide_;                 ///< motion of every node when the wire slides along itself
  std::vector<double> resistance_;                     ///< of fluid and damping to a node's travel, times Δt² [kg]
  std::vector<Eigen::Vector3d> resisted_;  ///< and what it resists of its masses' and surface's slide [kg·m]
  std::vector<Eigen::Vector3d> restore_begin_, restore_velocity_;
  std::vector<State> backup_;  ///< per depth of halving
};

}  // namespace endovascular_sim::rod
