#include "rod/kkt/kkt_stepper.h"

#include <gtest/gtest.h>

#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kEi = 4.9469e-5;  // N·m², steel wire of 0.18 mm radius, E = 60 GPa
constexpr double kLength = 0.38;

// Heavy cantilever with wL³/EI = 8.75: exact tip (265.07, −252.90) mm.
TEST(KktStepper, HeavyCantileverHangsAsTheContinuum)
{
  const int nodes = 100;
  Environment environment;
  environment.gravity = Eigen::Vector3d(0.0, -9.81, 0.0);
  environment.damping = 30.0;
  KktStepper stepper(discretiseUniformly(uniformWire(clampedLength(kLength, nodes), kEi, 1.8e-4, 7900.0), nodes),
                     clampAtOrigin(kLength, nodes), environment, StepperSettings());
  State state = stepper.initialState(0.0, 0.0);
  ASSERT_GE(settle(stepper, state, StepInput(), 0.01, 1e-8, 20000), 0);
  EXPECT_NEAR(state.position.back().x(), 0.26507, 1.5e-4 * kLength);
  EXPECT_NEAR(state.position.back().y(), -0.25290, 1.5e-4 * kLength);
}

TEST(KktStepper, AFreeWireFallsFreelyAndStaysStraight)
{
  Environment environment;
  environment.gravity = Eigen::Vector3d(0.0, 0.0, -9.81);
  Boundary boundary;
  boundary.introducer = false;
  KktStepper stepper(discretiseUniformly(uniformWire(0.1, kEi, 1.8e-4, 7900.0), 20), boundary, environment,
                     StepperSettings());
  State state = stepper.initialState(0.0, 0.0);
  PhaseTimer timer;
  const double dt = 1e-3;
  for (int k = 0; k < 100; ++k)
  {
    std::uint32_t pass = 0;
    stepper.step(state, StepInput(), dt, pass, nullptr, timer);
  }
  // Backward Euler falls g·dt²·k(k+1)/2.
  for (int i = 0; i < 20; ++i)
    EXPECT_NEAR(state.position[i].z(), -9.81 * dt * dt * 100 * 101 / 2, 1e-12);
}

TEST(KktStepper, AFreeWireKeepsLinearMomentumAndNearlyAllAngularMomentum)
{
  Boundary boundary;
  boundary.introducer = false;
  KktStepper stepper(discretiseUniformly(uniformWire(0.1, kEi, 1.8e-4, 7900.0), 30), boundary, Environment(),
                     StepperSettings());
  State state = stepper.initialState(0.0, 0.0);
  for (int i = 0; i < 30; ++i)
    state.velocity[i] = Eigen::Vector3d(0.02, 0.5 * std::sin(0.3 * i), 0.3 * std::cos(0.2 * i));
  const auto momentum = [&](const State& s)
  {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int i = 0; i < 30; ++i)
      sum += stepper.discretisation().mass[i] * s.velocity[i];
    return sum;
  };
  const Eigen::Vector3d before = momentum(state);
  PhaseTimer timer;
  for (int k = 0; k < 200; ++k)
  {
    std::uint32_t pass = 0;
    stepper.step(state, StepInput(), 1e-4, pass, nullptr, timer);
  }
  EXPECT_LT((momentum(state) - before).norm(), 1e-9 * before.norm());
}

/** Motion of a cantilever that swings down for 0.1 s. */
struct Swing
{
  State state;
  double strain = 0.0;  ///< largest strain
  int solves = 0;
};

Swing swing(double corrected_strain_ratio, LinearSolver solver = LinearSolver::kBanded)
{
  const int nodes = 60;
  Environment environment;
  environment.gravity = Eigen::Vector3d(0.0, -9.81, 0.0);
  StepperSettings settings;
  settings.corrected_strain_ratio = corrected_strain_ratio;
  settings.linear_solver = solver;
  KktStepper stepper(discretiseUniformly(uniformWire(clampedLength(kLength, nodes), kEi, 1.8e-4, 7900.0), nodes),
                     clampAtOrigin(kLength, nodes), environment, settings);
  Swing result;
  result.state = stepper.initialState(0.0, 0.0);
  PhaseTimer timer;
  for (int k = 0; k < 20; ++k)
  {
    std::uint32_t pass = 0;
    const StepReport report = stepper.step(result.state, StepInput(), 5e-3, pass, nullptr, timer);
    result.strain = std::max(result.strain, report.max_strain);
    result.solves += report.solves;
  }
  return result;
}

TEST(KktStepper, KeepsLengthsByACorrectionAsWellAsByAnotherSolve)
{
  const Swing solved = swing(0.0);
  const Swing corrected = swing(400.0);
  EXPECT_GT(solved.solves, 30) << "the motion stretches the edges";
  EXPECT_LE(corrected.strain, StepperSettings().strain_tolerance);
  EXPECT_LT(corrected.solves, solved.solves);
  EXPECT_LT((corrected.state.position.back() - solved.state.position.back()).norm(), 0.01 * kLength);
  EXPECT_LT((corrected.state.proximal_force - solved.state.proximal_force).norm(),
            0.02 * solved.state.proximal_force.norm());
  const Swing sparse = swing(400.0, LinearSolver::kSparse);
  EXPECT_LT((corrected.state.position.back() - sparse.state.position.back()).norm(), 1e-9);
}

TEST(KktStepper, InsertsAStraightWireWithoutForceOrStrain)
{
  const double length = 0.2;
  KktStepper stepper(discretiseUniformly(uniformWire(length, kEi, 1.8e-4, 7900.0), 101), Boundary(), Environment(),
                     StepperSettings());
  State state = stepper.initialState(0.005, 0.0);
  PhaseTimer timer;
  StepInput input;
  input.inserted_length = 0.005;
  for (int k = 0; k < 3000; ++k)
  {
    std::uint32_t pass = 0;
    input.inserted_length += 3e-5;
    input.rotation += 1e-3;
    const StepReport report = stepper.step(state, input, 1e-3, pass, nullptr, timer);
    ASSERT_TRUE(report.solved);
    ASSERT_LT(report.max_strain, 1e-9);
  }
  EXPECT_NEAR(state.position.back().x(), 0.095, 1e-9);
  EXPECT_NEAR(state.hand_force, 0.0, 1e-9);
  EXPECT_NEAR(state.twist_angle.back(), state.rotation, 1e-12);
  EXPECT_EQ(timer.seconds(Phase::kTwist), 0.0);
  EXPECT_EQ(timer.seconds(Phase::kCollision), 0.0);
}

TEST(KktStepper, GivesTheSameBitsForTheSameInputs)
{
  const auto run = []
  {
    Environment environment;
    environment.gravity = Eigen::Vector3d(0.0, -9.81, 0.0);
    KktStepper stepper(discretiseUniformly(uniformWire(kLength, kEi, 1.8e-4, 7900.0), 60), clampAtOrigin(kLength, 60),
                       environment, StepperSettings());
    State state = stepper.initialState(0.0, 0.0);
    PhaseTimer timer;
    for (int k = 0; k < 50; ++k)
    {
      std::uint32_t pass = 0;
      stepper.step(state, StepInput(), 1e-3, pass, nullptr, timer);
    }
    return state.hash();
  };
  EXPECT_EQ(run(), run());
}

TEST(KktStepper, RejectsAStepThatCannotBeSolvedAndKeepsTheWiresPosition)
{
  KktStepper stepper(discretiseUniformly(uniformWire(kLength, kEi, 1.8e-4, 7900.0), 20), clampAtOrigin(kLength, 20),
                     Environment(), StepperSettings());
  State state = stepper.initialState(0.0, 0.0);
  const std::vector<Eigen::Vector3d> before = state.position;
  PhaseTimer timer;
  StepInput input;
  input.forces.push_back({19, Eigen::Vector3d(std::nan(""), 0.0, 0.0)});
  std::uint32_t pass = 0;
  const StepReport report = stepper.step(state, input, 1e-3, pass, nullptr, timer);
  EXPECT_FALSE(report.solved);
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_EQ(state.position[i], before[i]);
}

}  // namespace
}  // namespace endovascular_sim::rod
