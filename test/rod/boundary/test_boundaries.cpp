#include <random>

#include <gtest/gtest.h>

#include "test/rod/kkt_stepper_peer.h"
#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kEi = 4.9469e-5;  // N·m²
constexpr double kGj = kEi / 1.3;  // N·m², as in uniformWire
constexpr double kLength = 0.2;
constexpr double kRadius = 1.8e-4;
constexpr double kDensity = 7900.0;

Wire benchWire(int nodes, EndHold hold = EndHold::kClamped)
{
  return uniformWire(heldLength(kLength, nodes, hold), kEi, kRadius, kDensity);
}

Environment dampedEnvironment()
{
  Environment environment;
  environment.damping = 100.0;
  return environment;
}

StepReport run(KktStepper& stepper, State& state, StepInput input, double dt, int steps)
{
  PhaseTimer timer;
  StepReport total;
  for (int k = 0; k < steps; ++k)
  {
    std::uint32_t pass = 0;
    input.step = static_cast<std::uint64_t>(k);
    total.add(stepper.step(state, input, dt, pass, nullptr, timer));
  }
  return total;
}

// A wire between two clamps on a circle takes its shape: equal turning angles, no force, the energy of the arc.
TEST(Boundaries, TwoTiltedClampsBendTheWireToAnArcWithoutForce)
{
  const int nodes = 42;
  const double angle = 1.2;
  const double edge = kLength / (nodes - 2);
  const double turn = angle / (nodes - 2);
  Eigen::Vector3d end(0.5 * edge, 0.0, 0.0);  // of the discrete arc, from clamp to clamp
  for (int j = 1; j < nodes - 2; ++j)
    end += edge * Eigen::Vector3d(std::cos(j * turn), std::sin(j * turn), 0.0);
  end += 0.5 * edge * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);

  KktStepper stepper(discretiseUniformly(benchWire(nodes), nodes), heldAtBothEnds(kLength, nodes, EndHold::kClamped),
                     dampedEnvironment(), StepperSettings());
  State state = stepper.initialState(0.0, 0.0);
  StepInput input;
  const int approach = 200;
  for (int k = 1; k <= approach; ++k)
  {
    const double share = static_cast<double>(k) / approach;
    input.distal.displacement = share * (end - Eigen::Vector3d(kLength, 0.0, 0.0));
    input.distal.tilt = Eigen::Vector3d(0.0, 0.0, share * angle);
    ASSERT_TRUE(run(stepper, state, input, 1e-3, 1).solved);
    const Eigen::Vector3d last = state.position[nodes - 1];
    const Eigen::Vector3d before = state.position[nodes - 2];
    ASSERT_LT((0.5 * (last + before) - Eigen::Vector3d(kLength, 0.0, 0.0) - input.distal.displacement).norm(), 1e-15);
    ASSERT_NEAR(std::atan2((last - before).y(), (last - before).x()), share * angle, 1e-12);
  }
  ASSERT_GE(settle(stepper, state, input, 5e-3, 1e-9, 5000), 0);
  for (int i = 1; i + 1 < nodes; ++i)
  {
    const Eigen::Vector3d e = state.position[i] - state.position[i - 1];
    const Eigen::Vector3d g = state.position[i + 1] - state.position[i];
    EXPECT_NEAR(std::atan2(e.cross(g).z(), e.dot(g)), turn, 1e-7);
  }
  const double scale = kEi / (kLength * kLength);
  EXPECT_LT(state.proximal_force.norm(), 1e-5 * scale);
  EXPECT_LT(state.distal_force.norm(), 1e-5 * scale);
  EXPECT_NEAR(stepper.energy(state).bending, (nodes - 2) * kEi / (2.0 * edge) * std::pow(2.0 * std::tan(0.5 * turn), 2),
              1e-9 * scale);
}

TEST(Boundaries, ForcesOnBothHoldsCarryTheWeightAndPullAgainstEachOther)
{
  for (const EndHold hold : {EndHold::kPinned, EndHold::kClamped})
  {
    const int nodes = 41;
    Environment environment = dampedEnvironment();
    environment.gravity = Eigen::Vector3d(0.0, -9.81, 0.0);
    KktStepper stepper(discretiseUniformly(benchWire(nodes, hold), nodes), heldAtBothEnds(kLength, nodes, hold),
                       environment, StepperSettings());
    State state = stepper.initialState(0.0, 0.0);
    StepInput input;
    for (int k = 1; k <= 400; ++k)
    {
      input.distal.displacement.x() = -2e-4 * k;
      ASSERT_TRUE(run(stepper, state, input, 1e-3, 1).solved);
    }
    ASSERT_GE(settle(stepper, state, input, 5e-3, 1e-9, 5000), 0);
    double weight = 0.0;
    for (const double mass : stepper.discretisation().mass)
      weight += 9.81 * mass;
    EXPECT_NEAR(state.proximal_force.y(), -0.5 * weight, 1e-5 * weight);
    EXPECT_NEAR(state.distal_force.y(), -0.5 * weight, 1e-5 * weight);
    EXPECT_NEAR(state.proximal_force.x(), -state.distal_force.x(), 1e-5 * weight);
    EXPECT_GT(std::abs(state.distal_force.x()), 0.01 * weight);
  }
}

TEST(Boundaries, APinnedEndCarriesNoMomentAndAClampDoes)
{
  const int nodes = 41;
  Boundary boundary = heldAtBothEnds(kLength, nodes, EndHold::kPinned);
  KktStepper stepper(discretiseUniformly(benchWire(nodes, EndHold::kPinned), nodes), boundary, dampedEnvironment(),
                     StepperSettings());
  State state = stepper.initialState(0.0, 0.0);
  StepInput input;
  input.forces.push_back({nodes / 2, Eigen::Vector3d(0.0, 1e-3, 0.0)});
  for (int k = 1; k <= 100; ++k)
  {
    input.distal.displacement.x() = -1e-4 * k;
    ASSERT_TRUE(run(stepper, state, input, 1e-3, 1).solved);
  }
  ASSERT_GE(settle(stepper, state, input, 5e-3, 1e-9, 5000), 0);
  // Moment at an inner node: EI·κ; at the last inner one it is only that of the end's force over one edge.
  const auto curvature = [&](int i)
  {
    const Eigen::Vector3d e = state.position[i] - state.position[i - 1];
    const Eigen::Vector3d g = state.position[i + 1] - state.position[i];
    return 2.0 * std::atan2(e.cross(g).norm(), e.norm() * g.norm() + e.dot(g)) / e.norm();
  };
  EXPECT_LT(curvature(1), 0.1 * curvature(nodes / 2));
  EXPECT_LT(curvature(nodes - 2), 0.1 * curvature(nodes / 2));
  EXPECT_GT(curvature(nodes / 2), 1.0);
}

TEST(Boundaries, TurningTheDistalClampTwistsAStraightWireOverFullTurns)
{
  const int nodes = 51;
  Boundary boundary = heldAtBothEnds(kLength, nodes, EndHold::kClamped);
  boundary.distal_twist_held = true;
  KktStepper stepper(discretiseUniformly(benchWire(nodes), nodes), boundary, Environment(), StepperSettings());
  State state = stepper.initialState(0.0, 0.0);
  StepInput input;
  const double turned = 7.0 * M_PI;
  for (int k = 1; k <= 200; ++k)
  {
    input.rotation = -0.25 * turned * k / 200;
    input.distal.rotation = 0.75 * turned * k / 200;
    ASSERT_TRUE(run(stepper, state, input, 1e-3, 1).solved);
  }
  EXPECT_NEAR(state.distal_torque, kGj * turned / kLength, 1e-12);
  EXPECT_NEAR(state.hand_torque, -kGj * turned / kLength, 1e-12);
  for (int j = 0; j + 1 < nodes; ++j)
    EXPECT_NEAR(state.twist_angle[j], turned * (-0.25 + static_cast<double>(j) / (nodes - 2)), 1e-9);
  EXPECT_NEAR(stepper.energy(state).twist, 0.5 * kGj * turned * turned / kLength, 1e-9);
}

/** A wavy wire in space between two clamps, its end edges along x. */
State wavyState(const KktStepper& stepper, double hand, double tip)
{
  State state = stepper.initialState(0.0, hand);
  state.distal.rotation = tip;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const int n = static_cast<int>(state.position.size());
  Eigen::Vector3d x = state.position[1];
  for (int i = 2; i < n; ++i)
  {
    Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
    if (i + 1 < n)
      direction += Eigen::Vector3d(0.0, std::sin(0.4 * i), std::cos(0.3 * i)) +
                   0.05 * Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
    x += stepper.discretisation().rest_length[i - 1] * direction.normalized();
    state.position[i] = x;
  }
  return state;
}

TEST(Boundaries, ForceOfATwistHeldAtBothEndsEqualsFiniteDifferencesOfTheEnergy)
{
  const int nodes = 24;
  for (const double curvature : {0.0, 60.0})
  {
    Wire wire = uniformWire(0.6 * kLength, kEi, kRadius, kDensity);
    wire.sections.push_back(wire.sections[0]);
    wire.sections[1].length = 0.4 * kLength;
    wire.sections[1].rest_curvature = Eigen::Vector2d(0.3 * curvature, -curvature);
    Boundary boundary = heldAtBothEnds(kLength, nodes, EndHold::kClamped);
    boundary.distal_twist_held = true;
    KktStepper stepper(discretiseUniformly(wire, nodes), boundary, Environment(), StepperSettings());
    const State state = wavyState(stepper, 0.4, 2.9);
    const std::vector<Eigen::Vector3d> gradient = KktStepperPeer::elasticGradient(stepper, state, StepInput());
    ASSERT_GT(stepper.energy(state).twist, 1e-3 * stepper.energy(state).bending);
    double largest = 0.0;
    for (const Eigen::Vector3d& g : gradient)
      largest = std::max(largest, g.norm());
    const double step = 1e-7;
    for (int i = 2; i + 2 < nodes; ++i)
      for (int axis = 0; axis < 3; ++axis)
      {
        State plus = state;
        State minus = state;
        plus.position[i][axis] += step;
        minus.position[i][axis] -= step;
        const Energy a = stepper.energy(plus);
        const Energy b = stepper.energy(minus);
        const double difference = (a.bending + a.twist - b.bending - b.twist) / (2.0 * step);
        EXPECT_NEAR(gradient[i][axis], difference, 2e-6 * largest) << "node " << i << " axis " << axis;
      }
  }
}

TEST(Boundaries, AWirePushedFromTheIntroducerAgainstAPinnedTipBuckles)
{
  const int nodes = 61;
  Boundary boundary;
  boundary.distal = EndHold::kPinned;
  KktStepper stepper(discretiseUniformly(uniformWire(0.2, kEi, kRadius, kDensity), nodes), boundary,
                     dampedEnvironment(), StepperSettings());
  State state = stepper.initialState(0.1, 0.0);
  const Eigen::Vector3d tip = state.position.back();
  StepInput input;
  input.inserted_length = 0.1;
  input.forces.push_back({45, Eigen::Vector3d(0.0, 1e-5, 0.0)});
  for (int k = 1; k <= 400; ++k)
  {
    input.inserted_length += 2.5e-5;
    ASSERT_TRUE(run(stepper, state, input, 1e-3, 1).solved);
  }
  ASSERT_GE(settle(stepper, state, input, 5e-3, 1e-7, 5000), 0);
  EXPECT_EQ(state.position.back(), tip);
  // Exact elastica between a sliding sleeve and a pin at 1.1 L (benchmark sleeve): the axial force is 17.26 EI/L², and
  // the configurational force takes 3.11 EI/L² of it from the hand.
  const double unit = kEi / (0.1 * 0.1);
  EXPECT_NEAR(state.hand_force, 14.15 * unit, 0.03 * 14.15 * unit);
  EXPECT_NEAR(state.distal_force.x(), 17.26 * unit, 0.03 * 17.26 * unit);
  EXPECT_NEAR(state.distal_force.x(), state.hand_force - state.hand_parts.configurational, 1e-3 * unit);
}

// A straight wire has no side to buckle to: after a small shortening the step is rejected and the wire stays.
TEST(Boundaries, AStraightWireShortenedAlongItsAxisIsRejectedNotCrushed)
{
  const int nodes = 41;
  KktStepper stepper(discretiseUniformly(benchWire(nodes), nodes), heldAtBothEnds(kLength, nodes, EndHold::kClamped),
                     Environment(), StepperSettings());
  State state = stepper.initialState(0.0, 0.0);
  StepInput input;
  bool rejected = false;
  for (int k = 1; k <= 500; ++k)
  {
    input.distal.displacement.x() = -5e-5 * k;
    rejected = !run(stepper, state, input, 1e-3, 1).solved || rejected;
    ASSERT_LE(maxStrain(stepper.discretisation(), state), 1e-2);
  }
  EXPECT_TRUE(rejected);
}

}  // namespace
}  // namespace endovascular_sim::rod
