#pragma once

#include <vector>

#include "rod/kkt/kkt_stepper.h"
#include "rod/kkt/layer_stack.h"

namespace endovascular_sim::rod
{

/** Access of the tests to the parts of a KktStepper. */
struct KktStepperPeer
{
  /** Gradient of the elastic energy at the nodes of a state whose twist has been relaxed [N]. */
  static std::vector<Eigen::Vector3d> elasticGradient(KktStepper& stepper, State state, const StepInput& input)
  {
    PhaseTimer unused;
    stepper.last_input_ = input;
    stepper.layers_->advance(state, input, 1.0);
    const TwistAction twist = stepper.layers_->relaxTwist(state, input, {}, unused);
    KktSystem& system = stepper.system_;
    system.reset(state.first_node, stepper.model_.rod.nodes());
    stepper.assembly_.addAllBending({state, state.position, twist, nullptr, input.forces, input.drags, 1.0, true});
    std::vector<Eigen::Vector3d> gradient(state.position.size(), Eigen::Vector3d::Zero());
    for (int i = system.first; i < stepper.model_.rod.nodes(); ++i)
      for (int axis = 0; axis < 3; ++axis)
        gradient[i][axis] = -system.rhs[system.row(i) + axis];
    return gradient;
  }

  /** ∂E/∂ℓ of every layer at fixed nodes, the other insertions fixed: of its elastic energy, its weight and, where its
   *  tip lies between the wall and the layer inside, of the wall's energy [N]. 0 for the reference. */
  static std::vector<double> insertionGradient(KktStepper& stepper, State state, const StepInput& input)
  {
    PhaseTimer unused;
    LayerStack& layers = stackOf(stepper);
    layers.place(state);
    layers.relaxTwist(state, input, {}, unused);
    std::vector<double> gradient(state.layers.size(), 0.0);
    for (int k = 0; k < layers.stack_.count(); ++k)
      if (k != state.reference)
        gradient[k] = layers.forces_.gradient(k, state) + layers.forces_.wedging(k, state);
    return gradient;
  }

  /** Layers of a stepper with several instruments. */
  static const ConcentricStack& stack(KktStepper& stepper) { return stackOf(stepper).stack(); }

private:
  static LayerStack& stackOf(KktStepper& stepper) { return dynamic_cast<LayerStack&>(*stepper.layers_); }
};

}  // namespace endovascular_sim::rod
