#pragma once

#include <vector>

#include "rod/kkt/kkt_model.h"
#include "rod/kkt/layer_model.h"
#include "rod/twist/bishop_frames.h"
#include "rod/twist/twist.h"

namespace endovascular_sim::rod
{

/** One wire: the nodes follow its material, and the rod's properties are its own. */
class SingleLayer : public LayerModel
{
public:
  /** @param model must outlive this */
  explicit SingleLayer(const KktModel& model) : model_(model) {}

  double length(int /*layer*/) const override { return model_.rod.length(); }
  State initialState(const std::vector<LayerInput>& layers) const override;
  State initialState(double inserted_length, double rotation) const override;
  bool beginStep(State& /*state*/, const StepInput& /*input*/, double /*dt*/, WallFriction& /*friction*/) override
  {
    return false;
  }
  const StepInput& centrelineInput(const State& /*state*/, const StepInput& input) override { return input; }
  void stop(State& /*state*/) override {}
  bool advance(State& state, const StepInput& input, double dt) override;
  TwistAction relaxTwist(State& state, const StepInput& input, const std::vector<TwistFriction>& friction,
                         PhaseTimer& timer) override;
  TwistAction predictTwist(State& state, const StepInput& input, const std::vector<TwistFriction>& friction,
                           bool first_solve, PhaseTimer& timer) override;
  bool isCurved() const override { return model_.rod.first_curved < model_.rod.nodes(); }
  void lineariseTwist(const State& state, SurfaceTwist& twist) override;
  void turnSurface(State& state, const std::vector<double>& turns, double share) override;
  void updateTorques(State& state, const StepInput& input, const std::vector<TwistFriction>& friction,
                     PhaseTimer& timer) override;
  void surfaceAngles(const State& state, std::vector<double>& angle) const override;
  void initialSurfaceAngles(const State& state, std::vector<double>& angle) const override;
  const std::vector<double>& frameTurns(const State& state) const override;
  int firstCountedTurn() const override { return frame_turns_.firstCounted(); }
  double restForce(const State& state) const override;
  double insertionWork(const State& before, const State& after) const override;
  const LayerSlides* slides() const override { return nullptr; }
  void finish(State& /*state*/, double /*dt*/) override {}
  double handleWork(const State& before, const State& after) const override;
  Energy energy(const State& state, const StepInput& input, WallFriction& friction) override;
  void addElasticEnergy(const State& state, PotentialEnergy& energy) override;
  void resample() override {}
  void restore(const State& /*state*/) override {}

private:
  const KktModel& model_;
  QuasiStaticTwist twist_;
  std::vector<double> initial_twist_;  ///< twist angles at the beginning of the step [rad]
  std::vector<double> saved_twist_;
  mutable FrameTurns frame_turns_;
  mutable std::vector<double> followed_twist_;  ///< initial twist angles less the turns of the frames [rad]
  TwistBoundary boundary_;                      ///< that of the last predictTwist()
  double rotation_before_ = 0.0;                ///< of the handle at the beginning of the step [rad]
};

}  // namespace endovascular_sim::rod
