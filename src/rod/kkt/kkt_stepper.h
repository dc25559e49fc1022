#pragma once

#include <memory>
#include <vector>

#include "rod/coaxial/concentric_stack.h"
#include "rod/contact/contact_solver.h"
#include "rod/contact/wall_friction.h"
#include "rod/energy/accepted_part.h"
#include "rod/kkt/active_set_solver.h"
#include "rod/kkt/kkt_assembly.h"
#include "rod/kkt/kkt_model.h"
#include "rod/kkt/kkt_reactions.h"
#include "rod/kkt/kkt_system.h"
#include "rod/kkt/layer_model.h"
#include "rod/stepping/step_bisection.h"
#include "rod/stepping/stepper.h"

namespace endovascular_sim::rod
{

/** The `kkt` scheme (docs/PHYSICS.md): backward Euler as one banded saddle system per solve.
 *
 *  Inextensibility is a constraint, bending Gauss–Newton, contact an active set of one-sided springs re-evaluated
 * inside the step, friction lagged in its normal force. A solve that would move a point further than its free distance
 * is truncated; contacts are detected again, and the same step is solved again. The instruments are a LayerModel.
 *
 *  Where the wall moves (StepInput::wall), the solves of a step begin with the nodes carried by the wall: their places
 *  in the resting wall are those before the step, so that only solves change them. */
class KktStepper : public Stepper
{
public:
  /** One wire. */
  KktStepper(Discretisation rod, Boundary boundary, Environment environment, StepperSettings settings);

  /** Several instruments, one inside the other (docs/PHYSICS.md, "Concentric stack").
   *  @param layers from the inside out, see ConcentricStack
   *  @param position of the nodes, from 0 to the longest wire's length [m]
   *  @throws std::invalid_argument for nodes that do not fit, or a boundary that holds the twist of the distal end */
  KktStepper(const std::vector<Layer>& layers, const std::vector<double>& position, Boundary boundary,
             Environment environment, StepperSettings settings);

  /** The first layer inserted, all others outside. */
  State initialState(double inserted_length, double rotation) const override
  {
    return layers_->initialState(inserted_length, rotation);
  }
  State initialState(const std::vector<LayerInput>& layers) const override { return layers_->initialState(layers); }
  double layerLength(int layer) const override { return layers_->length(layer); }
  StepReport step(State& state, const StepInput& input, double dt, std::uint32_t& pass,
                  contact::ContactSource* contacts, PhaseTimer& timer) override;
  Energy energy(const State& state) override { return layers_->energy(state, last_input_, friction_); }
  const contact::ContactSet& contactSet() const override { return contacts_.set(); }
  void setContactRadii(const std::vector<double>& radii) override;
  void invalidateContacts() override { contacts_.invalidate(); }
  const Discretisation& discretisation() const override { return model_.rod; }
  bool resample(const Discretisation& rod) override;
  void archive(Archive& archive, const State& state) override;
  void setObserver(SolutionObserver* observer) override { observer_ = observer; }

private:
  friend struct KktStepperPeer;  // of the tests

  bool advance(State& state, const StepInput& input, double dt, StepReport& report);
  double streamWork(const State& state, double dt) const;
  bool gainedEnergy(const State& before, const State& state, double dt);
  bool solveStep(State& state, const StepInput& input, double dt, StepReport& report);
  void placeEnds(State& state, const StepInput& input, double dt);
  void carry(State& state, const StepInput& input);
  void findWallTurns(const State& state);
  double wallWork(const State& state) const;
  bool iterate(State& state, const StepInput& input, double dt, StepReport& report);
  void assemble(const State& state, const StepInput& input, double dt, bool first_solve, const LayerSlides* slides);
  bool solve(const State& state, double dt, bool corrected, StepReport& report);
  bool restoreLengths(State& state, const StepInput& input, double dt, StepReport& report);
  bool restoreOnce(State& state, const StepInput& input, double dt, StepReport& report);
  double truncation(const State& state, StepReport& report);
  double move(State& state, double factor, StepReport& report);
  void accept(State& state, double dt);
  void finish(State& state, double dt);
  void relaxTwist(State& state, const StepInput& input, bool first_solve);
  const std::vector<double>& solution() const { return with_turns_ ? turn_solver_.solution() : solver_.solution(); }
  void updateTorques(State& state, const StepInput& input);
  void collectFriction(const State& state, double dt, bool first_solve);
  SurfaceMotion surfaceMotion() const;
  const contact::WallTravel* wall() const { return carried_ ? &travel_ : nullptr; }
  const std::vector<double>* wallTurn() const { return carried_ ? &wall_turn_ : nullptr; }
  void noteForces(double dt);
  void showPart(const State& before, const State& after, const StepInput& input, double dt);
  PotentialEnergy potentialEnergy(const State& state, int from);

  KktModel model_;
  std::unique_ptr<LayerModel> layers_;
  KktSystem system_;
  KktAssembly assembly_{model_, system_};
  ActiveSetSolver<PositionLayout> solver_{model_, system_};
  ActiveSetSolver<TurnLayout> turn_solver_{model_, system_};
  KktReactions reactions_;
  ContactSolver contacts_{model_.rod, model_.boundary, model_.settings};
  WallFriction friction_{model_.settings.friction_slip};
  StepBisection bisection_;

  TwistAction twist_;
  SurfaceTwist surface_twist_;
  bool turned_ = false;             ///< a handle turns in the present step
  bool carried_ = false;            ///< the wall moves in the present step
  contact::WallTravel travel_;      ///< motion of the wall in the present part of a step
  std::vector<double> wall_turn_;   ///< its turn about the wire's axis at every node [rad]
  std::vector<double> frame_turn_;  ///< of every edge, by that motion [rad]
  bool with_turns_ = false;         ///< the unknowns of the present solve include the turns of the surface
  ContactSolver::Motion motion_;    ///< increment of every node in the last solve [m]
  PhaseTimer* timer_ = nullptr;
  bool fading_ = true;                ///< the state may have offsets from a change of nodes
  bool hit_iteration_limit_ = false;  ///< the last step was accepted at the limit of solves
  double strain_ = 0.0;               ///< largest strain of the last accepted iterate
  StepInput last_input_;
  std::vector<Eigen::Vector3d> begin_;                         ///< positions at the beginning of the step [m]
  std::vector<Eigen::Vector3d> saved_begin_, saved_velocity_;  ///< while lengths are restored
  std::vector<double> surface_begin_, surface_angle_;          ///< angles of the surface at every node [rad]

  SolutionObserver* observer_ = nullptr;  ///< null: none
  ResistingForces resisting_;             ///< of the last accepted solution, for the observer
  double spring_energy_ = 0.0;            ///< likewise [J]
};

}  // namespace endovascular_sim::rod
