#include <Eigen/Eigenvalues>

#include <gtest/gtest.h>

#include "test/rod/kkt_stepper_peer.h"
#include "test/rod/rod_fixtures.h"

// Motion against the continuum and against the exact solution of backward Euler (references 10), momentum (11), and the
// order in the time step.

namespace endovascular_sim::rod
{
namespace
{

constexpr double kEi = 4.9469e-5;  // N·m²
constexpr double kLength = 0.38;
constexpr double kRadius = 1.8e-4;
constexpr double kDensity = 7900.0;
constexpr double kLineDensity = kDensity * M_PI * kRadius * kRadius;

Boundary freeWire()
{
  Boundary boundary;
  boundary.introducer = false;
  return boundary;
}

/** Transverse mode of the discrete straight wire. */
struct Mode
{
  double frequency;       ///< [rad/s]
  Eigen::VectorXd shape;  ///< y of every node, largest 1
};

/** Mode number @p index by frequency, from the stiffness of the stepper's own elastic forces. */
Mode modeOf(KktStepper& stepper, int held_nodes, int index)
{
  const int n = stepper.discretisation().nodes();
  const int free = n - held_nodes;
  const double small = 1e-7 * kLength;
  Eigen::MatrixXd stiffness(free, free);
  Eigen::VectorXd mass(free);
  for (int i = 0; i < free; ++i)
  {
    State state = stepper.initialState(0.0, 0.0);
    state.position[held_nodes + i].y() += small;
    const std::vector<Eigen::Vector3d> gradient = KktStepperPeer::elasticGradient(stepper, state, StepInput());
    for (int j = 0; j < free; ++j)
      stiffness(j, i) = gradient[held_nodes + j].y() / small;
    mass[i] = stepper.discretisation().mass[held_nodes + i];
  }
  const Eigen::VectorXd weight = mass.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = weight.asDiagonal() * stiffness * weight.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (scaled + scaled.transpose()));
  Mode mode{std::sqrt(solver.eigenvalues()[index]), Eigen::VectorXd::Zero(n)};
  mode.shape.tail(free) = weight.asDiagonal() * solver.eigenvectors().col(index);
  mode.shape /= mode.shape.lpNorm<Eigen::Infinity>();
  return mode;
}

/** Factor growth·exp(±i·angle) of a mode's amplitude in one step. */
struct Propagation
{
  double growth;
  double angle;  ///< [rad]
};

/** Fit of q(k+1) = a q(k) − b q(k−1) to the first steps of a wire that swings in one mode with a tiny amplitude. */
Propagation swing(KktStepper& stepper, const Mode& mode, double dt)
{
  State state = stepper.initialState(0.0, 0.0);
  const int n = stepper.discretisation().nodes();
  for (int i = 0; i < n; ++i)
    state.position[i].y() = 1e-5 * kLength * mode.shape[i];
  std::vector<double> amplitude;
  PhaseTimer timer;
  for (int k = 0; k < 40; ++k)
  {
    std::uint32_t pass = 0;
    EXPECT_TRUE(stepper.step(state, StepInput(), dt, pass, nullptr, timer).solved);
    double sum = 0.0;
    for (int i = 0; i < n; ++i)
      sum += stepper.discretisation().mass[i] * mode.shape[i] * state.position[i].y();
    amplitude.push_back(sum);
  }
  Eigen::MatrixXd past(amplitude.size() - 2, 2);
  Eigen::VectorXd next(amplitude.size() - 2);
  for (int k = 0; k < next.size(); ++k)
  {
    past.row(k) << amplitude[k + 1], -amplitude[k];
    next[k] = amplitude[k + 2];
  }
  const Eigen::Vector2d fit = (past.transpose() * past).inverse() * (past.transpose() * next);
  const double growth = std::sqrt(fit[1]);
  return {growth, std::acos(0.5 * fit[0] / growth)};
}

/** Frequency of the undamped wire with the phase @p angle per backward Euler step [rad/s]. */
double frequencyOf(const Propagation& propagation, double dt)
{
  return std::tan(propagation.angle) / dt;
}

// ΒL = 1.875104069 (cantilever), 4.730040745 (free).
TEST(ReferencesDynamics, VibratesAtTheFrequenciesOfTheBeam)
{
  const int nodes = 81;
  const double scale = std::sqrt(kEi / kLineDensity) / (kLength * kLength);
  KktStepper cantilever(discretiseUniformly(uniformWire(clampedLength(kLength, nodes), kEi, kRadius, kDensity), nodes),
                        clampAtOrigin(kLength, nodes), Environment(), StepperSettings());
  const Mode first = modeOf(cantilever, 2, 0);
  const double dt = 0.01 / first.frequency;
  const double clamped_exact = scale * 1.875104068711961 * 1.875104068711961;
  EXPECT_NEAR(frequencyOf(swing(cantilever, first, dt), dt), clamped_exact, 0.01 * clamped_exact);

  KktStepper free(discretiseUniformly(uniformWire(kLength, kEi, kRadius, kDensity), nodes), freeWire(), Environment(),
                  StepperSettings());
  const Mode bending = modeOf(free, 0, 2);  // after translation and rotation
  const double free_dt = 0.01 / bending.frequency;
  const double free_exact = scale * 4.730040744862704 * 4.730040744862704;
  EXPECT_NEAR(frequencyOf(swing(free, bending, free_dt), free_dt), free_exact, 0.01 * free_exact);
  // The discrete chain's own value, ratio 0.9993562282204456 for 80 edges.
  EXPECT_NEAR(frequencyOf(swing(free, bending, free_dt), free_dt), 0.9993562282204456 * free_exact, 1e-6 * free_exact);
}

// Growth per step of backward Euler 1/√(1 + ω²Δt²), turn atan(ωΔt).
TEST(ReferencesDynamics, DampsAModeOnlyByTheFactorOfBackwardEuler)
{
  const int nodes = 41;
  KktStepper stepper(discretiseUniformly(uniformWire(clampedLength(kLength, nodes), kEi, kRadius, kDensity), nodes),
                     clampAtOrigin(kLength, nodes), Environment(), StepperSettings());
  for (const int index : {0, 1, 2})
  {
    const Mode mode = modeOf(stepper, 2, index);
    const Propagation step = swing(stepper, mode, 0.1 / mode.frequency);
    EXPECT_NEAR(step.growth, 0.9950371902, 1e-6) << "mode " << index;
    EXPECT_NEAR(step.angle, std::atan(0.1), 1e-6) << "mode " << index;
  }
  const Mode mode = modeOf(stepper, 2, 0);
  EXPECT_NEAR(swing(stepper, mode, 0.5 / mode.frequency).growth, 1.0 / std::sqrt(1.25), 1e-6);
}

/** Position of the tip of a cantilever some time after its release from the straight state. */
Eigen::Vector3d fallenTip(double dt, double time)
{
  const int nodes = 31;
  Environment environment;
  environment.gravity.y() = -9.81;
  StepperSettings settings;
  settings.strain_tolerance = 1e-10;
  settings.max_iterations = 40;
  KktStepper stepper(discretiseUniformly(uniformWire(clampedLength(kLength, nodes), kEi, kRadius, kDensity), nodes),
                     clampAtOrigin(kLength, nodes), environment, settings);
  State state = stepper.initialState(0.0, 0.0);
  PhaseTimer timer;
  const int steps = static_cast<int>(std::lround(time / dt));
  for (int k = 0; k < steps; ++k)
  {
    std::uint32_t pass = 0;
    EXPECT_TRUE(stepper.step(state, StepInput(), dt, pass, nullptr, timer).solved);
  }
  return state.position.back();
}

TEST(ReferencesDynamics, LargeMotionConvergesWithFirstOrderInTheTimeStep)
{
  const double time = 0.2;
  const Eigen::Vector3d coarse = fallenTip(1e-4, time);
  const Eigen::Vector3d fine = fallenTip(5e-5, time);
  const Eigen::Vector3d finest = fallenTip(2.5e-5, time);
  ASSERT_GT(std::abs(finest.y()), 0.2 * kLength);
  EXPECT_NEAR(std::log2((coarse - fine).norm() / (fine - finest).norm()), 1.0, 0.1);
}

/** Largest relative change of angular momentum by inner forces in one step of a tumbling free wire, about the origin;
 *  forces act at the new positions. */
TEST(ReferencesDynamics, InnerForcesOfAFreeWireChangeNeitherMomentumNorMomentOfMomentum)
{
  const int nodes = 31;
  StepperSettings settings;
  settings.strain_tolerance = 1e-13;
  settings.max_iterations = 12;
  Wire wire = uniformWire(kLength, kEi, kRadius, kDensity);
  KktStepper stepper(discretiseUniformly(wire, nodes), freeWire(), Environment(), settings);
  State state = stepper.initialState(0.0, 0.0);
  for (int i = 0; i < nodes; ++i)
    state.velocity[i] = Eigen::Vector3d(0.02, 0.5 * std::sin(0.3 * i), 0.3 * std::cos(0.2 * i));
  PhaseTimer timer;
  double scale = 0.0;
  double angular_scale = 0.0;
  for (int i = 0; i < nodes; ++i)
  {
    scale += stepper.discretisation().mass[i] * state.velocity[i].norm();
    angular_scale += stepper.discretisation().mass[i] * state.velocity[i].norm() * kLength;
  }
  for (int k = 0; k < 100; ++k)
  {
    const State before = state;
    std::uint32_t pass = 0;
    stepper.step(state, StepInput(), 1e-3, pass, nullptr, timer);
    Eigen::Vector3d change = Eigen::Vector3d::Zero();
    Eigen::Vector3d turn = Eigen::Vector3d::Zero();
    for (int i = 0; i < nodes; ++i)
    {
      const Eigen::Vector3d impulse = stepper.discretisation().mass[i] * (state.velocity[i] - before.velocity[i]);
      change += impulse;
      turn += state.position[i].cross(impulse);
    }
    EXPECT_LT(change.norm(), 1e-10 * scale) << "step " << k;
    EXPECT_LT(turn.norm(), 1e-7 * angular_scale) << "step " << k;
  }
  EXPECT_GT((state.position.front() - state.position.back()).cross(Eigen::Vector3d::UnitX()).norm(), 1e-3);
}

/** Backward Euler reduces the angular momentum of a rotating free wire in proportion to the time step. */
TEST(ReferencesDynamics, LossOfAngularMomentumIsOfFirstOrderInTheTimeStep)
{
  const auto loss = [](double dt)
  {
    const int nodes = 31;
    StepperSettings settings;
    settings.strain_tolerance = 1e-12;
    KktStepper stepper(discretiseUniformly(uniformWire(kLength, kEi, kRadius, kDensity), nodes), freeWire(),
                       Environment(), settings);
    State state = stepper.initialState(0.0, 0.0);
    const auto momentum = [&]
    {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int i = 0; i < nodes; ++i)
        sum += stepper.discretisation().mass[i] * state.position[i].cross(state.velocity[i]);
      return sum.z();
    };
    for (int i = 0; i < nodes; ++i)
      state.velocity[i].y() = 5.0 * (state.position[i].x() - 0.5 * kLength);
    const double begin = momentum();
    PhaseTimer timer;
    for (int k = 0; k < static_cast<int>(std::lround(0.1 / dt)); ++k)
    {
      std::uint32_t pass = 0;
      stepper.step(state, StepInput(), dt, pass, nullptr, timer);
    }
    return 1.0 - momentum() / begin;
  };
  const double coarse = loss(1e-3);
  EXPECT_GT(coarse, 0.0);
  EXPECT_LT(coarse, 0.01);
  EXPECT_NEAR(std::log2(coarse / loss(5e-4)), 1.0, 0.05);
}

}  // namespace
}  // namespace endovascular_sim::rod
