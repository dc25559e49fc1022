#include "rod/mixed/mixed_stepper.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Vector3d;

constexpr double kEi = 4.9469e-5;  // N·m², steel wire of 0.18 mm radius, E = 60 GPa
constexpr double kLength = 0.38;
constexpr double kDensity = 7900.0;
constexpr double kRadius = 1.8e-4;

MixedStepper makeStepper(int nodes, EndHold proximal, const Environment& environment,
                         const StepperSettings& settings = StepperSettings())
{
  Boundary boundary;
  boundary.introducer = false;
  boundary.proximal = proximal;
  const Wire wire = uniformWire(kLength, kEi, kRadius, kDensity);
  return MixedStepper(wire, discretiseUniformly(wire, nodes), boundary, environment, settings);
}

void run(MixedStepper& stepper, State& state, StepInput input, double dt, int steps)
{
  PhaseTimer timer;
  for (int k = 0; k < steps; ++k)
  {
    std::uint32_t pass = 0;
    input.step = static_cast<std::uint64_t>(k);
    ASSERT_TRUE(stepper.step(state, input, dt, pass, nullptr, timer).solved);
  }
}

/** Gravity at which wL³/EI = 8.75. */
Environment heavyEnvironment(double damping)
{
  Environment environment;
  const double weight = 8.75 * kEi / (kLength * kLength * kLength);
  environment.gravity = Vector3d(0.0, -weight / (kDensity * M_PI * kRadius * kRadius), 0.0);
  environment.damping = damping;
  return environment;
}

TEST(MixedStepper, HeavyCantileverAt25NodesHasARelativeTipErrorBelow1e6)
{
  MixedStepper stepper = makeStepper(25, EndHold::kClamped, heavyEnvironment(20.0));
  State state = stepper.initialState(0.0, 0.0);
  run(stepper, state, StepInput(), 5e-3, 3000);
  const Vector3d exact(0.6975592593323616, -0.6655170278745548, 0.0);
  EXPECT_LT((state.position.back() / kLength - exact).norm(), 1e-6);
  EXPECT_LT(
      stepper
          .step(state, StepInput(), 5e-3, *std::make_unique<std::uint32_t>(0), nullptr, *std::make_unique<PhaseTimer>())
          .max_strain,
      1e-12);
}

// Coarse edges bend considerably between their nodes. Without the term −½ λ² b of the functional (compliance of the
// chord due to bending of the arc) the tension is unstable in this test.
TEST(MixedStepper, FallingWireIsStableOnCoarseMeshesAndConvergesWithFourthOrder)
{
  const auto tip = [](int nodes)
  {
    MixedStepper stepper = makeStepper(nodes, EndHold::kClamped, heavyEnvironment(0.0));
    State state = stepper.initialState(0.0, 0.0);
    run(stepper, state, StepInput(), 1e-3, 400);
    return Vector3d(state.position.back() / kLength);
  };
  const Vector3d fine = tip(97);
  const double coarse_error = (tip(9) - fine).norm();
  const double middle_error = (tip(17) - fine).norm();
  EXPECT_LT(coarse_error, 1e-3);
  EXPECT_NEAR(std::log2(coarse_error / middle_error), 4.0, 0.4);
  EXPECT_NEAR(std::log2(middle_error / (tip(33) - fine).norm()), 4.0, 0.3);
}

TEST(MixedStepper, MotionConvergesWithFirstOrderInTheTimeStep)
{
  const auto tip = [](int steps)
  {
    MixedStepper stepper = makeStepper(13, EndHold::kClamped, heavyEnvironment(0.0));
    State state = stepper.initialState(0.0, 0.0);
    run(stepper, state, StepInput(), 0.1 / steps, steps);
    return Vector3d(state.position.back());
  };
  const Vector3d a = tip(200);
  const Vector3d b = tip(400);
  const Vector3d c = tip(800);
  EXPECT_NEAR(std::log2((a - b).norm() / (b - c).norm()), 1.0, 0.1);
}

// (βL)² of the cantilever, first and third mode.
TEST(MixedStepper, VibratesAtTheFrequenciesOfTheBeamWithFourthOrder)
{
  const auto frequencies = [](int nodes)
  {
    const MixedStepper stepper = makeStepper(nodes, EndHold::kClamped, Environment());
    const State state = stepper.initialState(0.0, 0.0);
    const MixedRod& rod = stepper.model();
    MixedRod::Matrix banded;
    banded.reset(rod.size(state));
    std::vector<double> gradient(static_cast<std::size_t>(rod.size(state)), 0.0);
    rod.assemble(state, gradient, banded);
    const auto entry = [&](int row, int col)
    { return std::abs(row - col) <= MixedRod::kBandwidth ? banded.at(std::max(row, col), std::min(row, col)) : 0.0; };
    const int n = nodes - 1;  // deflections along y of the free nodes; moments about z of all nodes except the tip
    Eigen::MatrixXd coupling(n, n), flexibility(n, n), mass = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k)
      {
        coupling(i, k) = entry(rod.momentRow(state, i) + 2, rod.positionRow(state, k + 1) + 1);
        flexibility(i, k) = -entry(rod.momentRow(state, i) + 2, rod.momentRow(state, k) + 2);
      }
    for (int k = 0; k < n; ++k)
    {
      mass(k, k) = stepper.mass()[k + 1][0];
      if (k + 1 < n)
        mass(k, k + 1) = mass(k + 1, k) = stepper.mass()[k + 1][1];
    }
    const Eigen::MatrixXd stiffness = coupling.transpose() * flexibility.inverse() * coupling;
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness, mass);
    const double unit = kEi / (kDensity * M_PI * kRadius * kRadius * std::pow(kLength, 4));
    return std::make_pair(std::sqrt(solver.eigenvalues()[0] / unit), std::sqrt(solver.eigenvalues()[2] / unit));
  };
  const double first = 3.51601526850015;
  const double third = 61.697214413549105;
  const auto coarse = frequencies(81);
  const auto fine = frequencies(161);
  EXPECT_NEAR(fine.first, first, 1e-4 * first);
  EXPECT_NEAR(fine.second, third, 1e-3 * third);
  EXPECT_NEAR(std::log2((coarse.second - third) / (fine.second - third)), 4.0, 0.3);
}

TEST(MixedStepper, AFreeWireFallsFreelyAndStaysStraight)
{
  Environment environment;
  environment.gravity = Vector3d(0.0, 0.0, -9.81);
  MixedStepper stepper = makeStepper(12, EndHold::kFree, environment);
  State state = stepper.initialState(0.0, 0.0);
  const double dt = 1e-3;
  run(stepper, state, StepInput(), dt, 100);
  for (const Vector3d& position : state.position)
    EXPECT_NEAR(position.z(), -9.81 * dt * dt * 100 * 101 / 2, 1e-11);
}

TEST(MixedStepper, AFreeWireKeepsLinearMomentum)
{
  MixedStepper stepper = makeStepper(16, EndHold::kFree, Environment());
  State state = stepper.initialState(0.0, 0.0);
  for (int i = 0; i < 16; ++i)
    state.velocity[i] = Vector3d(0.02, 0.5 * std::sin(0.6 * i), 0.3 * std::cos(0.4 * i));
  const auto momentum = [&stepper](const State& s)
  {
    Vector3d sum = Vector3d::Zero();
    for (int i = 0; i < 16; ++i)
      sum += (stepper.mass()[i][0] + stepper.mass()[i][1] + (i > 0 ? stepper.mass()[i - 1][1] : 0.0)) * s.velocity[i];
    return sum;
  };
  const Vector3d before = momentum(state);
  run(stepper, state, StepInput(), 1e-4, 200);
  EXPECT_LT((momentum(state) - before).norm(), 1e-9 * before.norm());
}

TEST(MixedStepper, InsertsAStraightWireWithoutForceOrStrain)
{
  const Wire wire = uniformWire(0.2, kEi, kRadius, kDensity);
  MixedStepper stepper(wire, discretiseUniformly(wire, 41), Boundary(), Environment(), StepperSettings());
  State state = stepper.initialState(0.005, 0.0);
  PhaseTimer timer;
  StepInput input;
  input.inserted_length = 0.005;
  for (int k = 0; k < 3000; ++k)
  {
    std::uint32_t pass = 0;
    input.inserted_length += 3e-5;
    const StepReport report = stepper.step(state, input, 1e-3, pass, nullptr, timer);
    ASSERT_TRUE(report.solved);
    ASSERT_LT(report.max_strain, 1e-9);
  }
  EXPECT_NEAR(state.position.back().x(), 0.095, 1e-9);
  EXPECT_NEAR(state.hand_force, 0.0, 1e-9);
}

TEST(MixedStepper, GivesTheSameBitsForTheSameInputs)
{
  const auto hash = []
  {
    MixedStepper stepper = makeStepper(20, EndHold::kClamped, heavyEnvironment(0.0));
    State state = stepper.initialState(0.0, 0.0);
    run(stepper, state, StepInput(), 1e-3, 50);
    return state.hash();
  };
  EXPECT_EQ(hash(), hash());
}

TEST(MixedStepper, RejectsAStepThatCannotBeSolvedAndKeepsTheWiresPosition)
{
  MixedStepper stepper = makeStepper(10, EndHold::kClamped, Environment());
  State state = stepper.initialState(0.0, 0.0);
  const std::vector<Vector3d> before = state.position;
  PhaseTimer timer;
  StepInput input;
  input.forces.push_back({9, Vector3d(std::nan(""), 0.0, 0.0)});
  std::uint32_t pass = 0;
  EXPECT_FALSE(stepper.step(state, input, 1e-3, pass, nullptr, timer).solved);
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_EQ(state.position[i], before[i]);
}

}  // namespace
}  // namespace endovascular_sim::rod
