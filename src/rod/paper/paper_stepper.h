#pragma once

#include <vector>

#include "rod/boundary/boundary_conditions.h"
#include "rod/boundary/introducer_guide.h"
#include "rod/contact/wall_friction.h"
#include "rod/linear/banded_ldlt.h"
#include "rod/linear/sparse_solver.h"
#include "rod/paper/fast_projection.h"
#include "rod/stepping/stepper.h"
#include "rod/twist/twist.h"

namespace endovascular_sim::rod
{

/** The `paper` scheme (docs/PHYSICS.md): one linear implicit step (Baraff & Witkin 1998), then fast projection.
 *
 *  The step solves (M + Δt D + Δt² K) v⁺ = M v + Δt f at the positions where it begins, which is
 *  (M − Δt ∂f/∂v − Δt² ∂f/∂x) Δv = Δt (f + Δt ∂f/∂x v) with the unknown v⁺ = v + Δv: symmetric, positive definite,
 *  block-pentadiagonal (half bandwidth 8). K holds Gauss–Newton bending, stretch, the guide and contact. Contact is a
 *  spring of stiffness m/Δt² per feature: a force F penetrates F Δt²/m, whatever the wall's stiffness. Features are
 *  detected once per step, so that a fast wire may pass through a wall. The scheme is the baseline for `kkt`. */
class PaperStepper : public Stepper
{
public:
  PaperStepper(Discretisation rod, Boundary boundary, Environment environment, StepperSettings settings);

  State initialState(double inserted_length, double rotation) const override;

  /** Rejects a step whose result is not finite, or whose edges cannot be restored to their lengths: the wire keeps its
   *  position, at rest. Without a fresh contact set the wire waits. */
  StepReport step(State& state, const StepInput& input, double dt, std::uint32_t& pass,
                  contact::ContactSource* contacts, PhaseTimer& timer) override;
  Energy energy(const State& state) override;
  const contact::ContactSet& contactSet() const override { return contacts_; }
  void invalidateContacts() override { contacts_valid_ = false; }
  const Discretisation& discretisation() const override { return rod_; }
  bool resample(const Discretisation& rod) override;

private:
  static constexpr int kBandwidth = 8;

  /** Contact spring of a feature. */
  struct Spring
  {
    int node = 0;  ///< the edge's first node
    double weight0 = 0.0;
    double weight1 = 0.0;
    double mass = 0.0;  ///< effective mass; the stiffness is mass/Δt² [kg]
    bool active = false;
  };

  BoundaryConditions conditions() const { return BoundaryConditions(rod_, boundary_); }
  bool haveContacts(const State& state, StepReport& report);
  void detect(const State& state, StepReport& report);
  void hold(State& state);
  bool advanceOrRetry(State& state, const StepInput& input, double dt, StepReport& report);
  bool advance(State& state, const StepInput& input, double dt, StepReport& report);
  void beginStep(State& state, const StepInput& input, double dt);
  void assemble(const State& state, const StepInput& input, double dt);
  void addBending(int node, const State& state, double dt);
  void addStretch(int edge, const State& state, double dt);
  void addNodeTerms(int node, const State& state, double dt);
  void addGuide(const State& state, double dt);
  void addContacts(const State& state, double dt);
  Spring spring(const contact::Feature& feature, const State& state, double dt) const;
  void addForce(int node, const Eigen::Vector3d& force);
  void addBlock(int row_node, int col_node, const Eigen::Matrix3d& block);
  bool solve(const State& state, double dt, StepReport& report);
  bool project(State& state, double dt, StepReport& report);
  Eigen::Vector3d forceOnHold(int node, double dt) const;
  void updateWallForces(State& state, double dt);

  int row(int node) const { return 3 * (node - first_); }
  Eigen::Vector3d displacement(int node) const;

  Discretisation rod_;
  const Boundary boundary_;
  const Environment environment_;
  const StepperSettings settings_;

  const IntroducerGuide guide_{boundary_};
  GuideStiffness guide_form_ = GuideStiffness::kSemiDefinite;
  QuasiStaticTwist twist_;
  bool twist_active_ = false;
  FastProjection projection_;
  contact::ContactSet contacts_;
  contact::Query query_;
  bool contacts_valid_ = false;
  bool step_is_stale_ = false;
  contact::ContactSource* source_ = nullptr;
  PhaseTimer* timer_ = nullptr;
  std::uint32_t* pass_ = nullptr;
  std::uint64_t step_ = 0;
  std::uint32_t substep_ = 0;
  double last_tip_torque_ = 0.0;

  int first_ = 0;  ///< first simulated node
  BandedLdlt<kBandwidth> base_, matrix_;
  CholmodSolver cholmod_;
  std::vector<double> base_rhs_;
  std::vector<double> rhs_;  ///< after the solve, the displacements of the linear step [m]
  std::vector<Spring> springs_;
  WallFriction friction_{settings_.friction_slip};
  std::vector<double> inverse_mass_;
  std::vector<Eigen::Vector3d> begin_;  ///< positions at the beginning of the step
  State backup_;
};

}  // namespace endovascular_sim::rod
