#include "rod/twist/twist_friction.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "rod/kkt/kkt_stepper.h"
#include "rod/sampling/resampling.h"
#include "test/rod/node_wall.h"
#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Vector3d;

constexpr double kFriction = 0.2;
constexpr double kRadius = 1.8e-4;    // m, radius of the wire
constexpr double kClearance = 20e-6;  // m, radius of the trough less that of the wire
constexpr double kGravity = 4000.0;   // m/s²: presses the wire into the trough
constexpr double kLength = 0.2;       // m, free
constexpr double kDensity = 7900.0;   // kg/m³
constexpr double kTimeStep = 1e-3;    // s
constexpr double kEi = 5e-5;          // N·m²

Wire troughWire(double length, double torsional_stiffness)
{
  Wire wire = uniformWire(length, kEi, kRadius, kDensity);
  wire.sections.front().torsional_stiffness = torsional_stiffness;
  return wire;
}

/** Wire in a trough along x, clamped at the origin, where a handle turns it. */
class Spindle
{
public:
  Spindle(double torsional_stiffness, int nodes)
    : wire(troughWire(clampedLength(kLength, nodes), torsional_stiffness)),
      wall_(kRadius + kClearance, kFriction),
      stepper(discretiseUniformly(wire, nodes), boundary(nodes), environment(), StepperSettings()),
      state(stepper.initialState(0.0, 0.0))
  {
    hold(0.1);
  }

  void step()
  {
    std::uint32_t pass = 0;
    PhaseTimer timer;
    ++input.step;
    report.add(stepper.step(state, input, kTimeStep, pass, &wall_, timer));
  }

  void hold(double seconds)
  {
    for (int k = static_cast<int>(std::lround(seconds / kTimeStep)); k > 0; --k)
      step();
  }

  /** @param rate [rad/s] */
  void turnTo(double angle, double rate)
  {
    const double from = input.rotation;
    const int steps = static_cast<int>(std::lround(std::abs(angle - from) / (rate * kTimeStep)));
    for (int k = 1; k <= steps; ++k)
    {
      input.rotation = from + (angle - from) * k / steps;
      step();
    }
  }

  /** Torque of friction when the whole wire slides about its axis, for the present normal forces [N·m]. */
  double slidingTorque() const
  {
    double sum = 0.0;
    for (const Vector3d& force : state.wall_force)
      sum += kFriction * force.norm() * kRadius;
    return sum;
  }

  Wire wire;

private:
  static Boundary boundary(int nodes)
  {
    Boundary boundary = clampAtOrigin(kLength, nodes);
    boundary.origin.z() = -kClearance;
    return boundary;
  }

  static Environment environment()
  {
    Environment environment;
    environment.gravity = Vector3d(0.0, 0.0, -kGravity);
    environment.damping = 100.0;
    return environment;
  }

  TroughWall wall_;

public:
  KktStepper stepper;
  State state;
  StepInput input;
  StepReport report;
};

/** Weight of the wire per length [N/m]. A sliding wire climbs until friction balances it: N = weight/√(1 + μ²). */
double pressure()
{
  return kDensity * M_PI * kRadius * kRadius * kGravity / std::hypot(1.0, kFriction);
}

double potential(const TwistFriction& friction, double turn)
{
  const double u = std::sqrt(std::pow(friction.along + turn * friction.arm, 2) + friction.across_squared);
  return friction.limit * (u < friction.slip ? 0.5 * u * u / friction.slip : u - 0.5 * friction.slip);
}

TwistFriction exampleFriction(double along, double across)
{
  TwistFriction friction;
  friction.limit = 0.3;
  friction.slip = 0.5e-6;
  friction.arm = kRadius;
  friction.along = along;
  friction.across_squared = across * across;
  return friction;
}

TEST(TwistFriction, DerivativesAreThoseOfThePotentialAndTheSecantLiesAboveIt)
{
  for (const double across : {0.0, 0.2e-6, 0.7e-6})
    for (const double along : {-1.5e-6, -0.1e-6, 0.3e-6, 4e-6})
    {
      const TwistFriction friction = exampleFriction(along, across);
      for (const double turn : {-2.1e-3, 0.3e-3, 1.1e-3})
      {
        const double step = 1e-7;
        const double slope = (potential(friction, turn + step) - potential(friction, turn - step)) / (2.0 * step);
        const double curvature = (friction.pull(turn + step) - friction.pull(turn - step)) / (2.0 * step);
        const double most = friction.limit * friction.arm;
        EXPECT_NEAR(friction.pull(turn), slope, 1e-6 * most);
        EXPECT_NEAR(friction.stiffness(turn), curvature, 1e-6 * most * friction.arm / friction.slip);
        for (const double other : {-8e-3, -1e-3, 0.0, 2e-3, 9e-3})
        {
          const double d = other - turn;
          EXPECT_GE(potential(friction, turn) + friction.pull(turn) * d + 0.5 * friction.secant(turn) * d * d,
                    potential(friction, other) - 1e-15);
        }
      }
    }
}

/** Minimiser edge by edge, at the change of sign of each edge's gradient; independent of the solver. */
std::vector<double> minimiseByEdges(const Discretisation& rod, const TwistBoundary& boundary)
{
  const int edges = rod.nodes() - 1;
  std::vector<double> angle(static_cast<std::size_t>(edges), boundary.rotation);
  const auto gradient = [&](int edge)
  {
    double sum = 0.0;
    for (const int i : {edge, edge + 1})  // its nodes
      if (i > 0 && i < edges)
        sum += (i == edge ? 1.0 : -1.0) * rod.torsional_stiffness[i] / rod.cell_length[i] * (angle[i] - angle[i - 1]);
    for (const TwistFriction& friction : *boundary.friction)
      for (const int side : {std::max(friction.node - 1, 0), std::min(friction.node, edges - 1)})
        if (side == edge)
          sum += 0.5 * friction.pull(nodeAngle(angle, friction.node, 0) - friction.begin_angle);
    return sum;
  };
  for (int sweep = 0; sweep < 4000; ++sweep)
    for (int j = 1; j < edges; ++j)
    {
      double low = -2.0;
      double high = 2.0;
      for (int k = 0; k < 52; ++k)
      {
        angle[j] = 0.5 * (low + high);
        (gradient(j) > 0.0 ? high : low) = angle[j];
      }
    }
  return angle;
}

TEST(TwistFriction, AnglesMinimiseThePotential)
{
  const int nodes = 9;
  const Discretisation rod = discretiseUniformly(troughWire(0.05, 2e-6), nodes);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int trial = 0; trial < 4; ++trial)
  {
    std::vector<TwistFriction> frictions;
    for (int i = 1; i < nodes; ++i)
    {
      if (trial % 2 == 1 && i % 3 == 0)
        continue;
      TwistFriction friction = exampleFriction(0.4e-6 * uniform(random), 2e-6 * trial * uniform(random));
      friction.node = i;
      friction.limit = 0.05 * (1.0 + 0.9 * uniform(random));
      friction.begin_angle = 0.1 * uniform(random);
      frictions.push_back(friction);
    }
    TwistBoundary boundary;
    boundary.position = 0.5 * rod.rest_length[0];  // middle of the first edge, which therefore turns with the handle
    boundary.rotation = 0.3;
    boundary.friction = &frictions;
    State state;
    for (int i = 0; i < nodes; ++i)
      state.position.emplace_back(rod.position[i], 0.0, 0.0);
    state.twist_angle.assign(nodes - 1, 0.0);
    QuasiStaticTwist twist;
    twist.solve(rod, boundary, state);
    const std::vector<double> expected = minimiseByEdges(rod, boundary);
    for (int j = 0; j + 1 < nodes; ++j)
      EXPECT_NEAR(state.twist_angle[j], expected[j], 1e-8) << trial << " " << j;
    double torque = 0.0;
    for (const TwistFriction& friction : frictions)
      torque += friction.pull(nodeAngle(expected, friction.node, 0) - friction.begin_angle);
    EXPECT_NEAR(state.hand_torque, torque, 1e-6 * std::abs(torque)) << trial;
  }
}

TEST(TwistFriction, SpinningNeedsTheTorqueOfSlidingAndTheTipLagsByTheWindUp)
{
  const double gj = 1e-5;
  const int nodes = 81;
  Spindle spindle(gj, nodes);
  spindle.turnTo(0.8, 1.0);
  const double torque = spindle.state.hand_torque;
  EXPECT_NEAR(torque, spindle.slidingTorque(), 0.005 * torque);
  const double h = kLength / (nodes - 1.5);
  const double pressed = kLength - h;  // the clamp carries the cells of its two nodes
  EXPECT_NEAR(torque, kFriction * pressure() * pressed * kRadius, 0.01 * torque);
  const double lag = torque * (h + 0.5 * pressed) / gj;
  EXPECT_NEAR(spindle.input.rotation - spindle.state.twist_angle.back(), lag, 0.01 * lag);
  EXPECT_TRUE(spindle.report.solved);
}

/** Partial slip of a wire rotated by φ at its proximal end. A uniform friction torque τ per length acts beyond h, and
 * the wire slides up to h + l: φ = τ l h/GJ + τ l²/2GJ. (For h = 0: l = √(2 GJ φ/τ).) */
struct PartialSlip
{
  PartialSlip(double gj, double tau, double turn, double h)
    : gj(gj), tau(tau), turn(turn), h(h), l(std::sqrt(h * h + 2.0 * gj * turn / tau) - h)
  {
  }

  double torque() const { return tau * l; }
  double angle(double x) const
  {
    return x < h ? turn - tau * l * x / gj : 0.5 * tau / gj * std::pow(std::max(0.0, l + h - x), 2);
  }

  double gj, tau, turn, h, l;
};

TEST(TwistFriction, WindsUpOnlyAsFarAsTheClosedFormOfPartialSlip)
{
  const double gj = 2.5e-7;
  const double turn = 4.0;
  const double tau = kFriction * pressure() * kRadius;
  for (const int nodes : {21, 41, 81})
  {
    Spindle spindle(gj, nodes);
    spindle.turnTo(turn, 4.0);
    const double h = kLength / (nodes - 1.5);
    const PartialSlip expected(gj, tau, turn, h);  // the clamp carries the cells of its two nodes
    EXPECT_NEAR(spindle.state.hand_torque, expected.torque(), 0.005 * expected.torque()) << nodes;
    for (int j = 0; j + 1 < nodes; ++j)
      EXPECT_NEAR(spindle.state.twist_angle[j], expected.angle(j * h), 0.005 * turn) << nodes << " " << j;
  }
}

TEST(TwistFriction, HoldsTheWindUpWithoutCreepAndRunsThroughTheLoopOfHysteresis)
{
  const double turn = 4.0;
  Spindle spindle(2.5e-7, 41);
  spindle.turnTo(turn, 4.0);
  spindle.hold(0.2);
  const double wound = spindle.state.hand_torque;
  const std::vector<double> before = spindle.state.twist_angle;
  spindle.hold(10.0);
  for (std::size_t j = 0; j < before.size(); ++j)
    EXPECT_NEAR(spindle.state.twist_angle[j], before[j], 1e-9) << j;
  EXPECT_NEAR(spindle.state.hand_torque, wound, 1e-6 * wound);
  // Reversal changes the friction torque by twice its limit: T = T₀ (1 − 2 √(Δφ/2φ)), which is zero at Δφ = φ/2. The
  // wire then rolls to the other side of the trough (0.05 rad), which friction does not resist.
  spindle.turnTo(0.5 * turn, 4.0);
  EXPECT_NEAR(spindle.state.hand_torque, 0.0, 0.05 * wound);
  spindle.turnTo(-turn, 4.0);
  EXPECT_NEAR(spindle.state.hand_torque, -wound, 0.005 * wound);
  spindle.turnTo(turn, 4.0);
  EXPECT_NEAR(spindle.state.hand_torque, wound, 0.005 * wound);
}

TEST(TwistFriction, AWoundWireContinuesFromItsStateBitForBit)
{
  Spindle spindle(2.5e-7, 21);
  spindle.turnTo(1.0, 4.0);
  const State saved = spindle.state;
  const StepInput input = spindle.input;
  spindle.turnTo(1.5, 4.0);
  const std::uint64_t hash = spindle.state.hash();
  const double torque = spindle.state.hand_torque;
  spindle.state = saved;
  spindle.input = input;
  spindle.stepper.invalidateContacts();
  spindle.turnTo(1.5, 4.0);
  EXPECT_EQ(spindle.state.hash(), hash);
  EXPECT_EQ(spindle.state.hand_torque, torque);
}

TEST(TwistFriction, AWoundWireStaysWoundWhenItIsResampled)
{
  Spindle spindle(2.5e-7, 41);
  spindle.turnTo(4.0, 4.0);
  const double wound = spindle.state.hand_torque;
  const Discretisation coarse = spindle.stepper.discretisation();
  std::vector<double> position = coarse.position;
  for (const int i : {30, 12, 9})  // edges that are halved: sliding, sliding, at rest
    position.insert(position.begin() + i + 1, 0.5 * (coarse.position[i] + coarse.position[i + 1]));
  const Discretisation fine = discretise(spindle.wire, position);
  Resampling resampling;
  for (int k = 0; k < 10; ++k)
  {
    const bool split = k % 2 == 0;
    resampling.carry(spindle.wire, split ? coarse : fine, split ? fine : coarse, spindle.state);
    ASSERT_TRUE(spindle.stepper.resample(split ? fine : coarse));
    spindle.hold(0.05);
  }
  EXPECT_NEAR(spindle.state.hand_torque, wound, 0.01 * wound);
}

/** Wire that is pushed out of an introducer into a trough and turned at the same time. */
struct Drill
{
  /** @param speed of the push [m/s] @param turning speed of the surface [m/s] */
  Drill(double speed, double turning)
  {
    const double radius = 4.5e-4;
    const double clearance = 5e-4;
    const Wire wire = uniformWire(0.2, 2e-3, radius, kDensity);
    Boundary boundary;
    boundary.origin = Vector3d(0.0, 0.0, -clearance);
    Environment environment;
    environment.gravity = Vector3d(0.0, 0.0, -100.0);
    KktStepper stepper(discretiseUniformly(wire, 101), boundary, environment, StepperSettings());
    TroughWall wall(radius + clearance, kFriction);
    StepInput input;
    input.inserted_length = 0.1;
    state = stepper.initialState(input.inserted_length, 0.0);
    for (int k = 0; k < 1000; ++k)
    {
      input.step = static_cast<std::uint64_t>(k);
      if (k >= 100)
      {
        input.inserted_length += speed * kTimeStep;
        input.rotation += turning / radius * kTimeStep;
      }
      std::uint32_t pass = 0;
      PhaseTimer timer;
      report.add(stepper.step(state, input, kTimeStep, pass, &wall, timer));
      if (k < 700)
        continue;
      axial += state.hand_force / 300.0;
      torque += state.hand_torque / radius / 300.0;
      for (const Vector3d& force : state.wall_force)
        limit += kFriction * force.norm() / 300.0;
    }
  }

  State state;
  StepReport report;
  double axial = 0.0;   // mean force on the hand [N]
  double torque = 0.0;  // mean torque on the hand by the wire's radius [N]
  double limit = 0.0;   // mean of the largest friction [N]
};

TEST(TwistFriction, IsSharedBetweenSlidingAlongTheAxisAndAboutIt)
{
  for (const double angle : {0.0, 30.0, 60.0, 80.0})
  {
    const double along = std::cos(angle * M_PI / 180.0);
    const double about = std::sin(angle * M_PI / 180.0);
    const Drill drill(0.02 * along, 0.02 * about);
    EXPECT_NEAR(drill.axial, along * drill.limit, 0.003 * drill.limit) << angle;
    EXPECT_NEAR(drill.torque, about * drill.limit, 0.003 * drill.limit) << angle;
  }
}

TEST(TwistFriction, IsZeroForAHandleThatDoesNotTurn)
{
  const Drill drill(0.02, 0.0);
  EXPECT_EQ(drill.state.hand_torque, 0.0);
  for (std::size_t j = static_cast<std::size_t>(drill.state.first_node); j < drill.state.twist_angle.size(); ++j)
    EXPECT_EQ(drill.state.twist_angle[j], 0.0);
  for (const Vector3d& position : drill.state.position)
    EXPECT_EQ(position.y(), 0.0);
}

}  // namespace
}  // namespace endovascular_sim::rod
