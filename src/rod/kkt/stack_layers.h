#pragma once

#include <vector>

#include "rod/kkt/concentric_stack.h"
#include "rod/kkt/kkt_stepper.h"

namespace endovascular_sim::rod
{

/** Several instruments on one centreline in the `kkt` scheme (docs/PHYSICS.md, "Concentric stack").
 *
 *  Every layer is inserted and turned by a hand of its own (StepInput::layers) and has its own twist; at a fixed
 *  centreline the layers' twists do not depend on each other. The centreline moves as one rod of the layers' summed
 *  stiffness. State::layers holds what each hand feels. */
class StackStepper : public KktStepper
{
public:
  /** @param layers from the inside out, see ConcentricStack
   *  @param position of the nodes, from 0 to the longest wire's length [m]
   *  @throws std::invalid_argument for nodes that do not fit, or a boundary that holds the twist of the far end */
  StackStepper(const std::vector<Layer>& layers, const std::vector<double>& position, Boundary boundary,
               Environment environment, StepperSettings settings);

  /** The longest inserted layer becomes the reference.
   *  @throws std::invalid_argument when there is not one input for every layer */
  State initialState(const std::vector<LayerInput>& layers) const;

  /** All layers but the first one outside. */
  State initialState(double inserted_length, double rotation) const override;

  /** Of all layers; bending counts from each layer's own rest shape. */
  Energy energy(const State& state) override;

  bool resample(const Discretisation& rod) override;
  void archive(Archive& archive, const State& state) override;

  /** ∂E/∂ℓ of every layer at fixed nodes, the others' insertions fixed: of its elastic energy, its weight and, where
   *  its tip stands between the wall and the layer inside, of the wall's [N]; for tests. The reference's is not one of
   *  them: 0. */
  std::vector<double> insertionGradient(State state, const StepInput& input);

  /** Insertion at which a layer is outside, where it can be exchanged [m]. */
  double outside() const { return -boundary().guide_length - 2.0 * stack_rod().rest_length.front(); }

  /** Puts another instrument, outside too, in the place of a layer that is outside.
   *  @throws std::invalid_argument when the layer is inside, is the reference, or the new wire is longer than the nodes
   */
  void exchange(State& state, int k, Layer layer);

  /** How far a layer can be inserted: the introducer's guide must stay filled [m]. */
  double maxInsertion(int k) const;

  const ConcentricStack& stack() const { return stack_; }

protected:
  bool run(State& state, const StepInput& input, double dt, StepReport& report) override;
  void refreshRod(State& state, const StepInput& input, double dt) override;
  TwistAction relaxTwist(State& state, const StepInput& input, const std::vector<TwistFriction>& friction) override;
  void surfaceAngles(const State& state, std::vector<double>& angle) const override;
  void surfaceBeginAngles(const State& state, std::vector<double>& angle) const override;
  bool turns(const State& state, const StepInput& input) const override;
  void renewTorques(State& state, const StepInput& input) override;
  void complete(State& state, double dt) override;
  double handWork(const State& before, const State& after) const override;
  const std::vector<Eigen::Vector3d>* surfaceSlide() const override { return slides_ ? &surface_slide_ : nullptr; }
  const std::vector<MassSlide>* massSlide() const override { return slides_ ? &mass_slide_ : nullptr; }

private:
  class Side;

  /** Along the nodes: between one and the next. */
  struct Place
  {
    int node = 0;
    double share = 0.0;  ///< of the way to the next one
  };

  const Discretisation& stack_rod() const { return discretisation(); }
  void place(const State& state);
  void relaxFromHere(State& state);
  bool relaxLayer(int k, State& state, TwistBoundary boundary, const StepInput& input,
                  const std::vector<TwistFriction>& friction, bool again);
  void setLayerFriction(int k, const std::vector<TwistFriction>& friction);
  void combineTwists(const State& state);
  bool setEdgeTorque(int k, const State& state, const StepInput& input);
  void changeReference(State& state, int k, double dt);
  void moveAlong(State& state, double distance) const;
  Eigen::Vector3d tangent(const State& state, int node) const;
  Place placeAt(double place) const;
  Eigen::Vector3d momentAt(int node, const State& state) const;
  Eigen::Vector3d restAt(int k, const Eigen::Vector2d& curvature, const Place& at, const State& state) const;
  Side othersAt(int k, double place, const Place& at, const State& state) const;
  double nextEnd(int k, double begin, double end) const;
  double jointForce(int k, double place, const Section& before, const Section* after, const State& state) const;
  double gradientByInsertion(int k, const State& state) const;
  double widening(int k, int node, const LayerProfile::Slope& slope) const;
  double gradientAtNode(int k, int node, const State& state) const;
  double wallDrag(int k, const State& state) const;
  double motionDrag(int k, const State& state, double dt) const;
  void setSlides(const State& state);
  double axialFriction(int k, int outer, const State& state) const;
  int nextOuter(int k, const State& state) const;
  void dragLayers(State& state, const StepInput& input) const;
  void setHandForces(State& state, double dt);
  void setLoads(State& state);
  void addMoments(int k, const State& state);
  void setLoad(std::vector<double>& load, int end, const State& state) const;
  void setBodyShares(const State& state);
  double load(int k, int outer, int node, const State& state) const;
  bool sticks(int k, const State& state) const;
  void setTorqueLimits(const State& state);
  double meanTurn(int k, int outer, const State& state) const;
  double turnCompliance(int k, int outer, double held) const;
  double turnPerShare(int k, double turn, double share, double compliance, bool first) const;
  bool turnLayers(State& state, double held, bool first);
  void settleTurns(State& state) const;

  ConcentricStack stack_;
  std::vector<QuasiStaticTwist> twist_;  ///< per layer
  std::vector<char> twisted_;            ///< layers whose twist acts on the centreline
  std::vector<Eigen::Vector3d> rest_binormal_;
  std::vector<double> torque_;
  int first_curved_ = 0;
  std::vector<double> turn_before_, share_before_;  ///< per pair, before the friction torque was last changed
  std::vector<std::vector<double>> torque_limit_;   ///< of friction with the next outer layer, per edge [N·m]
  std::vector<std::vector<double>> begin_twist_;    ///< of every layer at the beginning of the step [rad]
  std::vector<TwistFriction> layer_friction_;       ///< of the wall on one layer
  std::vector<double> edge_torque_, behind_, force_before_;
  std::vector<Eigen::Vector3d> surface_slide_, binormal_, moment_;
  std::vector<MassSlide> mass_slide_;
  std::vector<double> body_share_;  ///< of every node's cell that is in the body
  std::vector<double> moved_;       ///< insertion of every layer in the step [m]
  std::vector<double> gained_;      ///< the same less what it would be at the speed of the last step [m]
  State relaxed_;                   ///< for torques only
  bool slides_ = false;
  StepInput input_;
};

}  // namespace endovascular_sim::rod
