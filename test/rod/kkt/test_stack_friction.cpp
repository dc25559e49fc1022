#include <gtest/gtest.h>

#include "test/rod/stack_fixtures.h"

// Friction between the layers of a stack.

namespace endovascular_sim::rod
{
namespace
{

constexpr double kLength = 0.3;

/** Wire curved, and no softer, over its last 100 mm: curvature couples two layers more than torsion does. */
Wire curvedAtTip(Wire wire, double rest_curvature)
{
  if (rest_curvature == 0.0)
    return wire;
  Section tip = wire.sections.back();
  tip.length = 0.1;
  tip.rest_curvature = {rest_curvature, 0.0};
  wire.sections.back().length -= tip.length;
  wire.sections.push_back(tip);
  return wire;
}

/** Wire in a tight catheter: normal load 2 N/m over 100 mm. */
struct TightFit
{
  /** @param rest_curvature of both layers, over their last 100 mm [1/m] */
  explicit TightFit(double rest_curvature = 0.0)
  {
    StepperSettings settings;
    settings.corrected_strain_ratio = 0.0;  // the friction torques converge with the solves of a step
    settings.max_iterations = 12;
    Layer wire{curvedAtTip(uniformWire(kLength, 2e-5, 0.4e-3, 6000.0), rest_curvature), 0.1, 2.0};
    Layer catheter{curvedAtTip(uniformWire(kLength, 8e-5, 0.9e-3, 6000.0), rest_curvature)};
    stepper = std::make_unique<KktStepper>(std::vector<Layer>{wire, catheter}, equalNodes(kLength, 151), Boundary(),
                                           calm(), settings);
    state = stepper->initialState(input);
  }

  void moveTo(double insertion, double rotation, int count = 20)
  {
    input[0] = {insertion, rotation};
    StepInput all;
    all.layers = input;
    for (int k = 0; k < count; ++k)  // 20 repetitions: until inertia is negligible
    {
      std::uint32_t pass = 0;
      all.step = steps++;
      stepper->step(state, all, 0.1, pass, nullptr, timer);
    }
  }

  /** Largest torque between straight layers [N·m], and rotation of the wire at which they slip [rad]. */
  static constexpr double kLimit = 0.1 * 0.4e-3 * 2.0 * 0.1;
  static constexpr double kSlip = kLimit * 0.1 / 3.0 * (1.3 / 2e-5 + 1.3 / 8e-5);  // ∫(L − s)² ds/L² of both, by GJ

  std::vector<LayerInput> input = {{0.15, 0.0}, {0.1, 0.0}};
  std::unique_ptr<KktStepper> stepper;
  State state;
  PhaseTimer timer;
  std::uint64_t steps = 0;
};

TEST(StackFriction, FrictionBetweenLayersSticksSlidesAndHasHysteresis)
{
  TightFit fit;
  const double limit = 0.1 * 2.0 * 0.1;
  struct
  {
    double insertion, force;
  } const path[] = {{10e-6, 0.5},   {20e-6, 1.0}, {300e-6, 1.0}, {290e-6, 0.5},
                    {270e-6, -0.5}, {0.0, -1.0},  {20e-6, 0.0},  {200e-6, 1.0}};
  for (const auto& point : path)
  {
    fit.moveTo(0.15 + point.insertion, 0.0);
    EXPECT_NEAR(fit.state.layers[1].hand_force, -point.force * limit, 1e-4 * limit) << point.insertion;
    EXPECT_NEAR(fit.state.layers[0].hand_force, point.force * limit, 1e-2 * limit) << point.insertion;
  }
}

TEST(StackFriction, FrictionYieldsWhereAHandleWouldBearMoreThanItsBound)
{
  TightFit fit;
  const double limit = 0.1 * 2.0 * 0.1;
  fit.input[1].most_force = 0.4 * limit;
  for (const double insertion : {0.1503, 0.1506, 0.15})
  {
    fit.moveTo(insertion, 0.0);
    const double sign = insertion > 0.15 ? 1.0 : -1.0;
    EXPECT_LE(std::abs(fit.state.layers[1].hand_force), 0.4 * limit);
    EXPECT_NEAR(fit.state.layers[1].hand_force, -0.4 * sign * limit, 1e-3 * limit) << insertion;
    EXPECT_NEAR(fit.state.layers[0].hand_force, 0.4 * sign * limit, 1e-2 * limit) << insertion;
  }
}

TEST(StackFriction, AWireTurnedInATightCatheterTurnsItUntilItSlips)
{
  TightFit fit;
  const double limit = TightFit::kLimit;
  const double slip = TightFit::kSlip;
  fit.moveTo(0.15, 0.25 * slip);
  EXPECT_NEAR(fit.state.layers[0].hand_torque, 0.25 * limit, 0.01 * limit);
  EXPECT_NEAR(fit.state.layers[1].hand_torque, -0.25 * limit, 0.01 * limit);
  // The pair sticks again: the mean angle between both is 0.
  EXPECT_GT(fit.state.layers[1].twist_angle.back(), 0.0);
  EXPECT_LT(fit.state.layers[1].twist_angle.back(), 0.25 * slip);
  EXPECT_LT(fit.state.layers[0].twist_angle.back(), 0.25 * slip);
  for (const double turn : {0.9, 2.0, 10.0})
    fit.moveTo(0.15, turn * slip);
  EXPECT_NEAR(fit.state.layers[0].hand_torque, limit, 1e-2 * limit);
  EXPECT_NEAR(fit.state.layers[1].hand_torque, -limit, 1e-2 * limit);
  fit.moveTo(0.15, 9.0 * slip);  // half of the rotation that reverses the friction
  EXPECT_NEAR(fit.state.layers[0].hand_torque, 0.0, 0.02 * limit);
  fit.moveTo(0.15, 7.0 * slip);
  EXPECT_NEAR(fit.state.layers[0].hand_torque, -limit, 1e-2 * limit);
}

/** Curvature of both layers aligns them: a change of the friction turns them far less than straight layers. */
TEST(StackFriction, CurvedLayersThatStickConvergeSoonAndDoNotSlip)
{
  TightFit fit(40.0);
  const double stuck_at = fit.state.layers[0].friction_turn;
  for (const double turn : {0.2, -0.2, 0.3, 0.0})
  {
    fit.moveTo(0.15, turn * TightFit::kSlip, 3);
    const double soon = fit.state.layers[0].friction_share;
    fit.moveTo(0.15, turn * TightFit::kSlip, 60);
    EXPECT_NEAR(soon, fit.state.layers[0].friction_share, 0.05) << turn;
    EXPECT_EQ(fit.state.layers[0].friction_turn, stuck_at) << turn;
  }
}

}  // namespace
}  // namespace endovascular_sim::rod
