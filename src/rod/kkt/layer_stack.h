#pragma once

#include <vector>

#include "rod/coaxial/concentric_stack.h"
#include "rod/kkt/insertion_forces.h"
#include "rod/kkt/interlayer_friction.h"
#include "rod/kkt/kkt_model.h"
#include "rod/kkt/layer_model.h"
#include "rod/kkt/layer_twists.h"
#include "rod/twist/bishop_frames.h"

namespace endovascular_sim::rod
{

/** Several instruments on one centreline (docs/PHYSICS.md, "Concentric stack").
 *
 *  Every layer is inserted and turned by a handle of its own (StepInput::layers) and has its own twist; at a fixed
 *  centreline the twists do not depend on each other, except by friction. The centreline moves as one rod of the
 * layers' summed stiffness. The nodes follow the material of the reference, the layer that reaches furthest.
 * State::layers holds the force on every handle. */
class LayerStack : public LayerModel
{
public:
  /** @param layers from the inside out, see ConcentricStack
   *  @param model with the nodes of the stack; its rod gets the properties of all layers together. Must outlive this
   *  @throws std::invalid_argument for nodes that do not fit, or a boundary that holds the twist of the distal end */
  LayerStack(const std::vector<Layer>& layers, KktModel& model);

  double length(int layer) const override { return stack_.profile(layer).length(); }
  /** The layer inserted furthest becomes the reference. */
  State initialState(const std::vector<LayerInput>& layers) const override;
  State initialState(double inserted_length, double rotation) const override;
  bool beginStep(State& state, const StepInput& input, double dt, WallFriction& friction) override;
  const StepInput& centrelineInput(const State& state, const StepInput& input) override;
  void stop(State& state) override;
  bool advance(State& state, const StepInput& input, double dt) override;
  TwistAction relaxTwist(State& state, const StepInput& input, const std::vector<TwistFriction>& friction,
                         PhaseTimer& timer) override;
  TwistAction predictTwist(State& state, const StepInput& input, const std::vector<TwistFriction>& friction,
                           bool first_solve, PhaseTimer& timer) override;
  bool isCurved() const override { return firstCurved() < model_.rod.nodes(); }
  void lineariseTwist(const State& state, SurfaceTwist& twist) override;
  void turnSurface(State& state, const std::vector<double>& turns, double share) override;
  void updateTorques(State& state, const StepInput& input, const std::vector<TwistFriction>& friction,
                     PhaseTimer& timer) override;
  void surfaceAngles(const State& state, std::vector<double>& angle) const override;
  void initialSurfaceAngles(const State& state, std::vector<double>& angle) const override;
  const std::vector<double>& frameTurns(const State& state) const override;
  int firstCountedTurn() const override { return frame_turns_.firstCounted(); }
  double restForce(const State& state) const override;
  const LayerSlides* slides() const override { return sliding_ ? &slides_ : nullptr; }
  void finish(State& state, double dt) override;
  double handleWork(const State& before, const State& after) const override;
  /** Sum over all layers; bending counts from each layer's own rest shape. */
  Energy energy(const State& state, const StepInput& input, WallFriction& friction) override;
  void addElasticEnergy(const State& state, PotentialEnergy& energy) override;
  double insertionWork(const State& before, const State& after) const override;
  LayerFrictionWork frictionWork(const State& before, const State& after) const override;
  void resample() override { stack_.setNodes(model_.rod.position); }
  void restore(const State& state) override { place(state); }

  const ConcentricStack& stack() const { return stack_; }

private:
  friend struct KktStepperPeer;  // of the tests

  void place(const State& state);
  void updateSlides(const State& state);
  void changeReference(State& state, int k, const StepInput& input, double dt, WallFriction& friction);
  void moveAlong(State& state, double distance) const;
  void relaxAtRest(State& state, const StepInput& input, WallFriction& friction);
  TwistBoundary layerBoundary(int k, const TwistBoundary& boundary, const State& state, const StepInput& input,
                              const std::vector<TwistFriction>& friction);
  void sumTwists(State& state) const;
  int firstCurved() const;
  int turningLayer(int edge) const;
  bool setEdgeTorque(int k, const State& state, const StepInput& input);
  void updateHandForces(State& state, double dt) const;
  bool isBeyondBound(const State& state) const;
  void yieldToBounds(State& state, double dt);

  KktModel& model_;
  ConcentricStack stack_;
  LayerTwists twists_;
  InterlayerFriction friction_;
  InsertionForces forces_;
  std::vector<std::vector<double>> initial_twist_;  ///< twist angles of every layer at the beginning of the step [rad]
  std::vector<LayerMotion> motion_;                 ///< insertion of every layer in the step
  LayerSlides slides_;
  bool sliding_ = false;
  std::vector<double> behind_;  ///< distance of every layer's tip behind the reference's [m]
  std::vector<TwistFriction> layer_friction_;
  std::vector<double> edge_torque_, force_before_;
  StepInput input_;
  std::vector<double> turn_;                                   ///< rotation of every handle in the step [rad]
  TwistBoundary boundary_;                                     ///< of the reference, at the last predictTwist()
  const std::vector<TwistFriction>* wall_friction_ = nullptr;  ///< of the last predictTwist()
  std::vector<int> edge_layer_;                                ///< layer whose turn is the unknown of every edge
  mutable FrameTurns frame_turns_;
  mutable std::vector<std::vector<double>> followed_twist_;  ///< initial angles less the turns of the frames [rad]
  State relaxed_;                                            ///< state for the computation of torques
};

}  // namespace endovascular_sim::rod
