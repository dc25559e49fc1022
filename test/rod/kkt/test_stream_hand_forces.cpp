#include <cmath>

#include <gtest/gtest.h>

#include "rod/energy/energy_audit.h"
#include "test/rod/stack_fixtures.h"

// Forces on the hands of wires in a stream (StepInput::drags).

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kRadius = 1.8e-4;  // m
constexpr double kDensity = 6450.0;
constexpr double kPerLength = 0.154;  // N·s/m²: drag of the wire in blood
constexpr double kDt = 1e-3;          // s

TEST(StreamHandForces, AtRestEqualsADeadLoadWithItsReactionInTheOtherPartOfTheHandForce)
{
  Boundary boundary;  // an introducer
  const Discretisation rod = discretiseUniformly(uniformWire(0.08, 1.6e-6, kRadius, kDensity), 81);
  const std::vector<NodalDrag> drags = uniformStream(rod, kPerLength * Matrix3d::Identity(), Vector3d(-0.2, 0.3, 0.1));
  StepInput in_stream;
  StepInput loaded;
  in_stream.inserted_length = loaded.inserted_length = 0.03;
  in_stream.drags = drags;
  for (const NodalDrag& drag : drags)
    loaded.forces.push_back({drag.node, drag.coefficient * drag.stream});
  KktStepper stepper(rod, boundary, Environment(), StepperSettings());
  State streaming = stepper.initialState(0.03, 0.0);
  State dead = streaming;
  ASSERT_TRUE(relaxToEquilibrium(stepper, streaming, in_stream, 5e-3));
  ASSERT_TRUE(relaxToEquilibrium(stepper, dead, loaded, 5e-3));
  for (int i = streaming.first_node; i < rod.nodes(); ++i)
    EXPECT_LT((streaming.position[i] - dead.position[i]).norm(), 1e-8) << i;
  const double unit = std::abs(dead.hand_parts.load);
  EXPECT_GT(unit, 1e-4);
  EXPECT_EQ(streaming.hand_parts.load, 0.0);
  EXPECT_NEAR(streaming.hand_parts.drag, dead.hand_parts.load, 1e-6 * unit);
  EXPECT_NEAR(streaming.hand_parts.bending, dead.hand_parts.bending, 1e-6 * unit);
  EXPECT_NEAR(streaming.hand_force, dead.hand_force, 1e-6 * unit);
}

TEST(StreamHandForces, AStraightWirePushedAlongAStreamIsDraggedByTheRelativeVelocity)
{
  const double stream = -0.3;  // m/s: against the wire
  const double speed = 0.05;   // m/s
  KktStepper stepper(discretiseUniformly(uniformWire(0.16, 5e-5, kRadius, kDensity), 161), Boundary(), Environment(),
                     StepperSettings());
  State state = stepper.initialState(0.06, 0.0);
  StepInput input;
  input.inserted_length = 0.06;
  input.drags = uniformStream(stepper.discretisation(), kPerLength * Matrix3d::Identity(), Vector3d(stream, 0.0, 0.0));
  for (int k = 0; k < 100; ++k)
  {
    input.inserted_length += speed * kDt;
    ASSERT_TRUE(advanceFreely(stepper, state, input, kDt).solved);
  }
  double coefficient = 0.0;
  for (int i = state.first_node; i < 161; ++i)
    coefficient += input.drags[i].coefficient(0, 0);
  const HandForceParts& parts = state.hand_parts;
  const double drag = coefficient * (speed - stream);
  EXPECT_NEAR(parts.drag, drag, 1e-6 * drag);
  EXPECT_NEAR(state.hand_force, drag, 1e-6 * drag);
  EXPECT_NEAR(parts.bending, 0.0, 1e-6 * drag);
  EXPECT_NEAR(parts.sum(), state.hand_force, 1e-12);
}

TEST(StreamHandForces, EveryHandBearsTheStreamOnTheSurfaceOfItsOwnLayer)
{
  const double stream = -0.2;  // m/s
  const double length = 0.15;
  const Wire wire = uniformWire(length, 2e-5, 0.4e-3, 6000.0);
  const Wire catheter = uniformWire(length, 8e-5, 0.9e-3, 6000.0);
  KktStepper stepper({{wire}, {catheter}}, equalNodes(length, 76), Boundary(), Environment(), StepperSettings());
  std::vector<LayerInput> hands = {{0.08, 0.0}, {0.0507, 0.0}};
  State state = stepper.initialState(hands);
  StepInput input;
  input.drags = uniformStream(stepper.discretisation(), kPerLength * Matrix3d::Identity(), Vector3d(stream, 0.0, 0.0));
  const double speed[2] = {0.01, 0.03};  // m/s
  EnergyAudit audit;
  double push = 0.0;
  for (int k = 0; k < 210; ++k)
  {
    if (k == 10)  // at steady speeds
      stepper.setObserver(&audit);
    for (int m = 0; m < 2; ++m)
      hands[m].inserted_length += speed[m] * kDt;
    input.setHandles(hands);
    ASSERT_TRUE(advanceFreely(stepper, state, input, kDt).solved);
    for (int m = 0; m < 2; ++m)
      push += state.layers[m].hand_force * speed[m] * kDt;
  }
  double drag[2] = {0.0, 0.0};
  for (int i = state.first_node; i < 76; ++i)
  {
    const double beyond = stepper.discretisation().position[i] - (length - state.layers[0].inserted_length);
    const int layer = beyond < state.layers[1].inserted_length ? 1 : 0;
    drag[layer] += input.drags[i].coefficient(0, 0) * (speed[layer] - stream);
  }
  EXPECT_GT(drag[0], 1e-4);
  EXPECT_GT(drag[1], 1e-4);
  for (int m = 0; m < 2; ++m)
    EXPECT_NEAR(state.layers[m].hand_force, drag[m], 1e-3 * drag[m]) << m;
  EXPECT_NEAR(state.hand_parts.drag, drag[0] + drag[1], 1e-6 * drag[1]);
  EXPECT_NEAR(state.hand_parts.bending, 0.0, 1e-6 * drag[1]);
  const EnergyBalance& balance = audit.balance();
  const double work = -0.2 * (drag[0] * speed[0] + drag[1] * speed[1]);  // at the last forces, in 0.2 s
  EXPECT_NEAR(balance.stream, work, 0.05 * std::abs(work));
  EXPECT_NEAR(balance.error(), 0.0, 1e-3 * push);
}

}  // namespace
}  // namespace endovascular_sim::rod
