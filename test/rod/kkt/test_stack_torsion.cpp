#include <gtest/gtest.h>

#include "common/units.h"
#include "test/rod/stack_fixtures.h"

// Two pre-curved tubes on one centreline, clamped at the base and free at the end: the angle α between their natural
// bends obeys α″ = c sin α, c = κ1 κ2 EI1 EI2/(EI1 + EI2) (1/GJ1 + 1/GJ2): the equation of torque transmission in a
// bend, whose tables of base angle against tip angle hold for √c L.

namespace endovascular_sim::rod
{
namespace
{

using units::kDegree;
constexpr double kTubeLength = 0.1;  // [m]
constexpr int kTubeNodes = 42;

Wire tube(double bending_stiffness, double torsional_stiffness, double curvature)
{
  const double whole = kTubeLength * (kTubeNodes - 1) / (kTubeNodes - 2);  // the clamp acts in the first edge's middle
  Wire wire = uniformWire(whole, bending_stiffness, 0.5e-3, 6000.0);
  wire.sections[0].torsional_stiffness = torsional_stiffness;
  wire.sections[0].rest_curvature = Eigen::Vector2d(0.0, curvature);
  return wire;
}

/** Two tubes with rest curvatures of 8 and 6 /m, the outer one twice as stiff, with √c L = lambda. */
struct TwoTubes
{
  explicit TwoTubes(double lambda)
  {
    const double torsional = kTubeLength * kTubeLength * 48.0 * (2e-3 / 3.0) * 1.5 / (lambda * lambda);
    Boundary boundary;
    boundary.introducer = false;
    boundary.proximal = EndHold::kClamped;
    const Wire inner = tube(1e-3, torsional, 8.0);
    stepper = std::make_unique<KktStepper>(std::vector<Layer>{{inner}, {tube(2e-3, 2.0 * torsional, 6.0)}},
                                           discretiseUniformly(inner, kTubeNodes).position, boundary, Environment(),
                                           StepperSettings());
    length = inner.length();
    state = stepper->initialState({{length, 0.0}, {length, 0.0}});
    turnTo(0.0);
  }

  /** Turns the inner tube's base against the outer's and waits; returns the angle at the tip [rad]. */
  double turnTo(double angle, double tolerance = 1e-9)
  {
    PhaseTimer timer;
    StepInput input;
    input.layers = {{length, angle}, {length, 0.0}};
    double motion = 1.0;
    for (int k = 0; k < 3000 && motion > tolerance; ++k)
    {
      const std::vector<Eigen::Vector3d> before = state.position;
      for (Eigen::Vector3d& velocity : state.velocity)
        velocity.setZero();
      std::uint32_t pass = 0;
      EXPECT_TRUE(stepper->step(state, input, 0.02, pass, nullptr, timer).solved);
      motion = (state.position.back() - before.back()).norm();
      ++solves;
    }
    return tip();
  }

  double tip() const { return state.layers[0].twist_angle.back() - state.layers[1].twist_angle.back(); }

  std::unique_ptr<KktStepper> stepper;
  State state;
  double length = 0.0;
  int solves = 0;
};

/** Tip angle with its base angle [deg]. */
struct Transmission
{
  double tip, base;
};

TEST(StackTorsion, TheAngleBetweenTwoPrecurvedTubesObeysTheTorsionEquation)
{
  TwoTubes soft(1.0);
  for (const Transmission& expected : {Transmission{30.0, 45.3527}, {60.0, 85.6915}, {120.0, 143.6538}})
    EXPECT_NEAR(soft.turnTo(expected.base * kDegree) / kDegree, expected.tip, 0.01 * expected.tip) << "soft";
  TwoTubes stiff(2.0);
  for (const Transmission& expected : {Transmission{30.0, 102.3419}, {60.0, 164.5306}, {90.0, 191.7823}})
    EXPECT_NEAR(stiff.turnTo(expected.base * kDegree) / kDegree, expected.tip, 0.01 * expected.tip) << "stiff";
}

TEST(StackTorsion, TubesSnapThroughWhereTheTorsionEquationLosesItsSolution)
{
  TwoTubes tubes(2.0);
  tubes.turnTo(150.0 * kDegree);
  double before = tubes.turnTo(190.0 * kDegree);
  double base = 190.0;
  double after = before;
  for (; base < 205.0 && after < before + 45.0 * kDegree; base += 0.5)
  {
    before = after;
    after = tubes.turnTo((base + 0.5) * kDegree);
  }
  EXPECT_NEAR(base, 197.7856, 2.0);
  EXPECT_NEAR(before / kDegree, 116.721, 10.0);  // the slope of the tip angle is infinite at this point
  EXPECT_NEAR(after / kDegree, 301.612, 3.0);
}

/** At α = 180° the tip turns by 1/cos(√c L) times as much as the base, without bound at √c L = π/2. */
TEST(StackTorsion, TheOppositePositionLosesItsStabilityAtAQuarterWave)
{
  for (const double lambda : {0.8 * M_PI / 2.0, 0.9 * M_PI / 2.0})
  {
    TwoTubes tubes(lambda);
    for (double base = 20.0; base <= 180.0; base += 20.0)
      tubes.turnTo(base * kDegree, 1e-6);
    const double opposite = tubes.turnTo(M_PI, 1e-11);
    EXPECT_NEAR(opposite, M_PI, 1e-4);
    const double turned = tubes.turnTo(M_PI + 1e-3, 1e-12) - opposite;
    EXPECT_NEAR(std::acos(1e-3 / turned), lambda, 0.01 * lambda);
  }
}

}  // namespace
}  // namespace endovascular_sim::rod
