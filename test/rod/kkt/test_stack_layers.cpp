#include <gtest/gtest.h>

#include "test/rod/node_wall.h"
#include "test/rod/stack_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kLength = 0.3;

double largestDifference(const State& a, const State& b)
{
  double largest = 0.0;
  for (std::size_t i = 0; i < a.position.size(); ++i)
    largest = std::max(largest, (a.position[i] - b.position[i]).norm());
  return largest;
}

TEST(LayerStack, OneLayerIsThePlainRodBitForBitWithContactRotationAndWeight)
{
  const Wire wire = curvedTipWire(kLength, 0.03, 2e-5, 0.4e-3, 60.0);
  Environment environment = calm();
  environment.gravity = Eigen::Vector3d(0.0, -9.81, 0.0);
  Boundary boundary;
  boundary.origin = Eigen::Vector3d(-0.03, 0.012, 0.0);
  CylinderWall wall(0.01, 0.2);
  KktStepper plain(discretiseUniformly(wire, 151), boundary, environment, StepperSettings());
  KktStepper stack({{wire}}, discretiseUniformly(wire, 151).position, boundary, environment, StepperSettings());
  State plain_state = plain.initialState(0.02, 0.0);
  State stack_state = stack.initialState({{0.02, 0.0}});
  PhaseTimer timer;
  bool touched = false;
  for (int k = 0; k < 300; ++k)
  {
    StepInput input;
    input.step = static_cast<std::uint64_t>(k);
    input.inserted_length = 0.02 + 1e-4 * k;
    input.rotation = 5e-3 * k;
    std::uint32_t pass = 0;
    plain.step(plain_state, input, 1e-3, pass, &wall, timer);
    input.layers = {{input.inserted_length, input.rotation}};
    pass = 0;
    stack.step(stack_state, input, 1e-3, pass, &wall, timer);
    for (const Eigen::Vector3d& force : stack_state.wall_force)
      touched = touched || !force.isZero(0.0);
  }
  EXPECT_TRUE(touched);
  EXPECT_EQ(largestDifference(plain_state, stack_state), 0.0);
  EXPECT_EQ(plain_state.twist_angle, stack_state.layers[0].twist_angle);
  EXPECT_EQ(plain_state.hand_force, stack_state.layers[0].hand_force);
  EXPECT_EQ(plain_state.hand_torque, stack_state.layers[0].hand_torque);
  const Energy plain_energy = plain.energy(plain_state);
  const Energy stack_energy = stack.energy(stack_state);
  EXPECT_EQ(plain_energy.bending, stack_energy.bending);
  EXPECT_EQ(plain_energy.twist, stack_energy.twist);
}

TEST(LayerStack, TwoEqualStraightLayersAreOneOfDoubleStiffnessAndMass)
{
  const Wire wire = uniformWire(kLength, 2e-5, 0.4e-3, 6000.0);
  Wire doubled = wire;
  doubled.sections[0].bending_stiffness *= 2.0;
  doubled.sections[0].torsional_stiffness *= 2.0;
  doubled.sections[0].density *= 2.0;
  Environment environment = calm();
  environment.gravity = Eigen::Vector3d(0.0, -9.81, 0.0);
  Boundary boundary;
  boundary.origin = Eigen::Vector3d(-0.03, 0.012, 0.0);
  CylinderWall wall(0.01, 0.2);
  KktStepper plain(discretiseUniformly(doubled, 101), boundary, environment, StepperSettings());
  KktStepper stack({{wire}, {wire}}, equalNodes(kLength, 101), boundary, environment, StepperSettings());
  State plain_state = plain.initialState(0.05, 0.0);
  State stack_state = stack.initialState({{0.05, 0.0}, {0.05, 0.0}});
  PhaseTimer timer;
  for (int k = 0; k < 200; ++k)
  {
    StepInput input;
    input.step = static_cast<std::uint64_t>(k);
    input.inserted_length = 0.05 + 1e-4 * k;
    std::uint32_t pass = 0;
    plain.step(plain_state, input, 1e-3, pass, &wall, timer);
    input.layers = {{input.inserted_length, 0.0}, {input.inserted_length, 0.0}};
    pass = 0;
    stack.step(stack_state, input, 1e-3, pass, &wall, timer);
  }
  EXPECT_LT(largestDifference(plain_state, stack_state), 1e-9);
  EXPECT_GT((stack_state.position.back() - Eigen::Vector3d(0.04, 0.012, 0.0)).norm(), 1e-3);
  EXPECT_NEAR(stack_state.hand_force, plain_state.hand_force, 1e-9);
  EXPECT_NEAR(stack.energy(stack_state).bending, plain.energy(plain_state).bending, 1e-12);
}

}  // namespace
}  // namespace endovascular_sim::rod
