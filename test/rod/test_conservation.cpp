#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "test/rod/kkt_stepper_peer.h"
#include "test/rod/rod_fixtures.h"

// Internal forces have no resultant force or moment.

namespace endovascular_sim::rod
{
namespace
{

constexpr double kEi = 4.9469e-5;  // N·m²
constexpr int kNodes = 30;
constexpr double kLength = 0.1;

Boundary freeBoundary()
{
  Boundary boundary;
  boundary.introducer = false;
  return boundary;
}

Wire preCurvedWire()
{
  Wire wire = uniformWire(kLength, kEi, 1.8e-4, 7900.0);
  wire.sections[0].length = 0.6 * kLength;
  wire.sections.push_back(wire.sections[0]);
  wire.sections[1].length = 0.4 * kLength;
  wire.sections[1].rest_curvature = Eigen::Vector2d(30.0, 12.0);
  return wire;
}

/** Bends the wire to a helix without stretching an edge. */
void bendIntoHelix(const Discretisation& rod, State& state)
{
  for (int j = 0; j + 1 < rod.nodes(); ++j)
  {
    const double angle = 0.17 * j;
    const Eigen::Vector3d tangent = Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.4 + 0.02 * j).normalized();
    state.position[j + 1] = state.position[j] + rod.rest_length[j] * tangent;
  }
}

struct Momentum
{
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();
};

Momentum momentumOf(const Discretisation& rod, const State& state)
{
  Momentum sum;
  for (int i = 0; i < rod.nodes(); ++i)
  {
    sum.linear += rod.mass[i] * state.velocity[i];
    sum.angular += rod.mass[i] * state.position[i].cross(state.velocity[i]);
  }
  return sum;
}

void expectNoResultant(const Wire& wire)
{
  KktStepper stepper(discretiseUniformly(wire, kNodes), freeBoundary(), Environment(), StepperSettings());
  State state = stepper.initialState(0.0, 0.3);
  bendIntoHelix(stepper.discretisation(), state);
  const std::vector<Eigen::Vector3d> gradient = KktStepperPeer::elasticGradient(stepper, state, StepInput());
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  double forces = 0.0;
  double moments = 0.0;
  for (int i = 0; i < kNodes; ++i)
  {
    force += gradient[i];
    moment += state.position[i].cross(gradient[i]);
    forces += gradient[i].norm();
    moments += state.position[i].cross(gradient[i]).norm();
  }
  EXPECT_GT(forces, 1e-3);
  EXPECT_LT(force.norm(), 1e-14 * forces);
  EXPECT_LT(moment.norm(), 1e-9 * moments);
}

TEST(Conservation, BendingForcesOfAStraightWireHaveNoResultantForceOrMoment)
{
  expectNoResultant(uniformWire(kLength, kEi, 1.8e-4, 7900.0));
}

TEST(Conservation, BendingAndTwistForcesOfAnUnheldPreCurvedWireHaveNoResultantForceOrMoment)
{
  expectNoResultant(preCurvedWire());
}

TEST(Conservation, ElasticEnergyDoesNotChangeWhenTheWireIsMovedAndTurned)
{
  KktStepper stepper(discretiseUniformly(preCurvedWire(), kNodes), freeBoundary(), Environment(), StepperSettings());
  State state = stepper.initialState(0.0, 0.3);
  bendIntoHelix(stepper.discretisation(), state);
  const Energy before = stepper.energy(state);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  for (Eigen::Vector3d& position : state.position)
    position = turn * position + Eigen::Vector3d(0.3, -0.1, 0.2);
  const Energy after = stepper.energy(state);
  EXPECT_GT(before.bending, 1e-5);
  EXPECT_NEAR(after.bending, before.bending, 1e-9 * before.bending);
  EXPECT_NEAR(after.twist, before.twist, 1e-9 * before.bending);
}

/** Relative loss of momentum of a free wire that flies, spins and vibrates for 20 ms. */
Momentum lostInFreeFlight(double dt)
{
  StepperSettings settings;
  settings.max_iterations = 40;
  settings.strain_tolerance = 1e-10;
  KktStepper stepper(discretiseUniformly(uniformWire(kLength, kEi, 1.8e-4, 7900.0), kNodes), freeBoundary(),
                     Environment(), settings);
  State state = stepper.initialState(0.0, 0.0);
  for (int i = 0; i < kNodes; ++i)
  {
    const double s = stepper.discretisation().position[i] / kLength - 0.5;
    state.velocity[i] = Eigen::Vector3d(0.02, 0.3 * s + 0.1 * std::cos(2.0 * M_PI * s), 0.2 * s * s);
  }
  const Momentum before = momentumOf(stepper.discretisation(), state);
  PhaseTimer timer;
  const int steps = static_cast<int>(std::lround(0.02 / dt));
  for (int k = 0; k < steps; ++k)
  {
    std::uint32_t pass = 0;
    stepper.step(state, StepInput(), dt, pass, nullptr, timer);
  }
  Momentum lost = momentumOf(stepper.discretisation(), state);
  lost.linear = (lost.linear - before.linear) / before.linear.norm();
  lost.angular = (lost.angular - before.angular) / before.angular.norm();
  return lost;
}

TEST(Conservation, AFlyingWireKeepsLinearMomentumAndLosesAngularMomentumWithFirstOrderInTheTimeStep)
{
  const Momentum coarse = lostInFreeFlight(1e-4);
  const Momentum fine = lostInFreeFlight(5e-5);
  const Momentum finest = lostInFreeFlight(2.5e-5);
  for (const Momentum& lost : {coarse, fine, finest})
    EXPECT_LT(lost.linear.norm(), 1e-10);  // roundoff of up to 800 steps, divided by the time step each
  EXPECT_NEAR(std::log2(coarse.angular.norm() / fine.angular.norm()), 1.0, 0.15);
  EXPECT_NEAR(std::log2(fine.angular.norm() / finest.angular.norm()), 1.0, 0.15);
}

}  // namespace
}  // namespace endovascular_sim::rod
