#include <gtest/gtest.h>

#include "rod/sampling/adaptive_sampling.h"
#include "test/rod/kkt_stepper_peer.h"
#include "test/rod/node_wall.h"
#include "test/rod/stack_fixtures.h"

// A stack on a wall, whose friction acts on the outermost layer.

namespace endovascular_sim::rod
{
namespace
{

constexpr double kLength = 0.3;
constexpr double kFriction = 0.2;
constexpr double kCatheterRadius = 0.9e-3;
constexpr double kWireRadius = 0.4e-3;

/** Straight wire in a straight catheter, both heavy, on a floor. */
struct OnFloor
{
  OnFloor()
  {
    const Wire wire = uniformWire(kLength, 2e-5, kWireRadius, 19000.0);
    const Wire catheter = uniformWire(kLength, 8e-5, kCatheterRadius, 8000.0);
    Environment environment = calm();
    environment.damping = 2.0;
    environment.gravity = Eigen::Vector3d(0.0, 0.0, -9.81);
    Boundary boundary;
    boundary.origin = Eigen::Vector3d(0.0, 0.0, kCatheterRadius);
    stepper = std::make_unique<KktStepper>(std::vector<Layer>{{wire}, {catheter}}, equalNodes(kLength, 151), boundary,
                                           environment, StepperSettings());
    state = stepper->initialState(input);
    step(200);
  }

  /** Advances in equal time steps [s] at given speeds of both handles. */
  void step(int count, const std::vector<LayerInput>& speed = {{}, {}}, double time_step = 5e-3)
  {
    for (int k = 0; k < count; ++k)
    {
      for (int layer = 0; layer < 2; ++layer)
      {
        input[layer].inserted_length += time_step * speed[layer].inserted_length;
        input[layer].rotation += time_step * speed[layer].rotation;
      }
      StepInput all;
      all.step = steps++;
      all.layers = input;
      std::uint32_t pass = 0;
      EXPECT_TRUE(stepper->step(state, all, time_step, pass, &floor, timer).solved);
    }
  }

  /** Normal force of the wall on a layer [N]. */
  double load(int layer) const
  {
    double sum = 0.0;
    for (int i = state.first_node; i < stepper->discretisation().nodes(); ++i)
      sum += KktStepperPeer::stack(*stepper).surfaceLayer(i) == layer ? state.wall_force[i].norm() : 0.0;
    return sum;
  }

  std::vector<LayerInput> input = {{0.16, 0.0}, {0.1, 0.0}};
  PlaneWall floor{kFriction};
  std::unique_ptr<KktStepper> stepper;
  State state;
  PhaseTimer timer;
  std::uint64_t steps = 0;
};

TEST(StackOnAWall, FrictionOfTheWallActsOnTheOutermostLayerOnly)
{
  for (const int pulled : {0, 1})
  {
    OnFloor setup;
    const double before = setup.state.layers[1 - pulled].hand_force;
    std::vector<LayerInput> speed(2);
    speed[pulled].inserted_length = -2e-3;
    setup.step(150, speed);
    const double friction = kFriction * setup.load(pulled);
    EXPECT_GT(friction, 2e-4);
    EXPECT_NEAR(setup.state.layers[pulled].hand_force, -friction, 0.1 * friction) << pulled;
    EXPECT_NEAR(setup.state.layers[1 - pulled].hand_force, before, 0.1 * friction) << pulled;
  }
}

// A layer rolls sideways on the floor before it slides: its torque is below that of sliding, and is compared with small
// steps.
TEST(StackOnAWall, TorqueOfTheWallActsOnTheLayerThatTurns)
{
  for (const int turning : {0, 1})
  {
    OnFloor setup, fine;
    std::vector<LayerInput> speed(2);
    speed[turning].rotation = 1.0;
    setup.step(300, speed);
    fine.step(1500, speed, 1e-3);
    const double reference = fine.state.layers[turning].hand_torque;
    const double sliding = kFriction * (turning == 1 ? kCatheterRadius : kWireRadius) * setup.load(turning);
    EXPECT_GT(reference, 0.4 * sliding) << turning;
    EXPECT_LT(reference, sliding) << turning;
    EXPECT_NEAR(setup.state.layers[turning].hand_torque, reference, 0.15 * reference) << turning;
    // The other layer is turned by the one that rolls, and its friction resists.
    const double largest = kFriction * kCatheterRadius * setup.load(1);
    EXPECT_LT(std::abs(setup.state.layers[1 - turning].hand_torque), 0.05 * largest) << turning;
  }
}

TEST(StackOnAWall, WireThatTurnsFarSlides)
{
  OnFloor setup;
  std::vector<LayerInput> speed(2);
  speed[0].rotation = 1.0;
  setup.step(1200, speed);
  const double sliding = kFriction * kWireRadius * setup.load(0);
  EXPECT_GT(sliding, 1e-7);
  EXPECT_NEAR(setup.state.layers[0].hand_torque, sliding, 0.1 * sliding);
}

TEST(StackOnAWall, AdaptiveNodesKeepTheLayers)
{
  const Wire wire = curvedTipWire(kLength, 0.02, 2e-5, kWireRadius, 70.0);
  const Wire catheter = curvedTipWire(kLength, 0.03, 8e-5, kCatheterRadius, 30.0);
  SamplingSettings settings;
  settings.min_edge = 0.5e-3;
  settings.max_edge = 4e-3;
  AdaptiveSampling sampling(wire, Boundary(), settings);
  const std::vector<Layer> layers = {{wire}, {catheter}};
  KktStepper adaptive(layers, sampling.discretisation().position, Boundary(), calm(), StepperSettings());
  KktStepper fine(layers, equalNodes(kLength, 601), Boundary(), calm(), StepperSettings());
  const std::vector<LayerInput> begin = {{0.1, 0.0}, {0.08, 0.5}};
  State state = adaptive.initialState(begin);
  State reference = fine.initialState(begin);
  PhaseTimer timer;
  int changes = 0;
  double jump = 0.0;
  double last = NAN;
  for (int k = 0; k < 600; ++k)
  {
    StepInput input;
    input.step = static_cast<std::uint64_t>(k);
    input.layers = begin;
    input.layers[1].inserted_length += 5e-5 * std::max(0, k - 300);
    std::uint32_t pass = 0;
    adaptive.step(state, input, 5e-3, pass, nullptr, timer);
    if (k > 310 && !std::isnan(last))  // the motion begins at once
      jump = std::max(jump, std::abs(state.layers[1].hand_force - last));
    last = state.layers[1].hand_force;
    pass = 0;
    fine.step(reference, input, 5e-3, pass, nullptr, timer);
    if (k % 10 == 0 && sampling.update(state))
    {
      adaptive.resample(sampling.discretisation());
      ++changes;
    }
  }
  EXPECT_GT(changes, 3);
  EXPECT_LT((state.position.back() - reference.position.back()).norm(), 0.5e-3);
  EXPECT_NEAR(state.layers[1].hand_force, reference.layers[1].hand_force,
              0.1 * std::abs(reference.layers[1].hand_force) + 1e-4);
  EXPECT_LT(jump, 5e-4);
}

}  // namespace
}  // namespace endovascular_sim::rod
