#include "rod/twist/twist.h"

#include <random>

#include <gtest/gtest.h>

#include "rod/energy/potential_energy.h"
#include "test/rod/kkt_stepper_peer.h"
#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

/** Bent and wavy wire in space, clamped at its proximal end. */
State bentState(const KktStepper& stepper, double rotation)
{
  State state = stepper.initialState(0.0, rotation);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::Vector3d x = state.position[1];
  for (std::size_t i = 2; i < state.position.size(); ++i)
  {
    const double s = static_cast<double>(i) / static_cast<double>(state.position.size());
    Eigen::Vector3d direction(std::cos(1.5 * s), std::sin(1.5 * s) * std::cos(2.0 * s),
                              std::sin(1.5 * s) * std::sin(2.0 * s));
    direction += 0.05 * Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
    x += stepper.discretisation().rest_length[i - 1] * direction.normalized();
    state.position[i] = x;
  }
  return state;
}

TEST(QuasiStaticTwist, TotalForceIncludingTheTwistEqualsFiniteDifferencesOfTheRelaxedEnergy)
{
  const int nodes = 25;
  Boundary boundary;
  boundary.introducer = false;
  boundary.proximal = EndHold::kClamped;
  KktStepper stepper(discretiseUniformly(curvedTipWire(80.0), nodes), boundary, Environment(), StepperSettings());
  const State state = bentState(stepper, 0.9);
  const std::vector<Eigen::Vector3d> gradient = KktStepperPeer::elasticGradient(stepper, state, StepInput());
  const double step = 1e-7;
  double largest = 0.0;
  for (const Eigen::Vector3d& g : gradient)
    largest = std::max(largest, g.norm());
  for (int i = 2; i < nodes; ++i)
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

/** Clamped wire whose hold of the twist is a part of an edge before the curved tip. */
struct TipAtTheMouth
{
  Discretisation rod = discretiseUniformly(curvedTipWire(80.0), 25);
  KktStepper stepper;
  State state;
  TwistBoundary boundary;
  int node = 22;  // whose cell contains the hold

  static Boundary clamped()
  {
    Boundary clamped;
    clamped.introducer = false;
    clamped.proximal = EndHold::kClamped;
    return clamped;
  }

  TipAtTheMouth() : stepper(rod, clamped(), Environment(), StepperSettings()), state(bentState(stepper, 0.9))
  {
    boundary.rotation = 0.9;
    boundary.tangent = (state.position[node] - state.position[node - 1]).normalized();
    boundary.director = boundary.tangent.unitOrthogonal();
  }

  /** Places the hold. @param share of the node's cell beyond it */
  void hold(double share)
  {
    boundary.position = rod.position[node] + (0.5 - share) * rod.cell_length[node];
    std::fill(state.twist_angle.begin(), state.twist_angle.begin() + node, boundary.rotation);
  }

  double potential() const
  {
    PotentialEnergy energy;
    addElasticEnergy(rod, boundary, state, state.twist_angle, energy);
    return energy.bending;
  }
};

TEST(QuasiStaticTwist, ForceAtTheHoldIsTheDerivativeOfTheBendingEnergyByItsArcLength)
{
  for (const double half_width : {0.3, 0.6, 1.0})
    for (const double share : {0.1, 0.35, 0.6, 0.85})
    {
      TipAtTheMouth tip;
      tip.boundary.half_width = half_width * tip.rod.cell_length[tip.node];
      QuasiStaticTwist twist;
      tip.hold(share);
      twist.solve(tip.rod, tip.boundary, tip.state);
      const double force = twist.holdForce(tip.rod, tip.state);
      const double step = 1e-4;
      tip.hold(share - step);
      double difference = tip.potential();
      tip.hold(share + step);
      difference -= tip.potential();
      EXPECT_GT(std::abs(force), 1e-3);
      EXPECT_NEAR(force, difference / (2.0 * step * tip.rod.cell_length[tip.node]), 1e-5 * std::abs(force))
          << half_width << ' ' << share;
    }
}

TEST(QuasiStaticTwist, RestCurvatureBeginsToActContinuouslyWhereTheMouthIsPassed)
{
  TipAtTheMouth tip;
  tip.boundary.half_width = 0.7 * tip.rod.cell_length[tip.node];
  QuasiStaticTwist twist;
  const auto binormal = [&](double share)
  {
    tip.hold(share);
    twist.solve(tip.rod, tip.boundary, tip.state);
    return twist.firstCurved() <= tip.node ? twist.restCurvatureBinormal(tip.node).norm() : 0.0;
  };
  // Share of the node's cell: its hat function is wider by half a cell on both sides.
  const double full = binormal(2.3);
  EXPECT_GT(full, 1e-2);
  EXPECT_LT(binormal(-1.3), 1e-8);
  double before = 0.0;
  for (double share = -1.3; share <= 2.3; share += 0.05)
  {
    const double now = binormal(share);
    EXPECT_GE(now, before - 1e-4 * full) << share;
    EXPECT_LE(now - before, 0.06 * full) << share;
    before = now;
  }
}

TEST(QuasiStaticTwist, AStraightWireTurnsAtItsTipExactlyAsAtTheHandle)
{
  const Discretisation rod = discretiseUniformly(uniformWire(0.1, 2e-3, 4e-4, 7000.0), 40);
  TwistBoundary boundary;
  EXPECT_FALSE(QuasiStaticTwist::matters(rod, boundary));
}

TEST(QuasiStaticTwist, ATorqueAtTheTipTwistsAStraightWireByLengthOverStiffness)
{
  const int nodes = 60;
  Boundary bench;
  bench.introducer = false;
  bench.proximal = EndHold::kClamped;
  const double ei = 2e-3;
  KktStepper stepper(discretiseUniformly(uniformWire(0.1, ei, 4e-4, 7000.0), nodes), bench, Environment(),
                     StepperSettings());
  State state = stepper.initialState(0.0, 0.4);
  StepInput input;
  input.rotation = 0.4;
  input.tip_torque = 1e-3;
  PhaseTimer timer;
  std::uint32_t pass = 0;
  stepper.step(state, input, 1e-3, pass, nullptr, timer);
  const double between_edges = 0.1 - 0.1 / (nodes - 1);
  EXPECT_NEAR(state.twist_angle.back(), 0.4 + 1e-3 * between_edges / (ei / 1.3), 1e-9);
  EXPECT_NEAR(state.hand_torque, -1e-3, 1e-12);
}

TEST(QuasiStaticTwist, TheRelaxedAnglesMinimiseTheEnergy)
{
  Boundary bench;
  bench.introducer = false;
  bench.proximal = EndHold::kClamped;
  KktStepper stepper(discretiseUniformly(curvedTipWire(80.0), 25), bench, Environment(), StepperSettings());
  State state = bentState(stepper, 0.9);
  QuasiStaticTwist twist;
  TwistBoundary boundary;
  boundary.position = 0.5 * stepper.discretisation().rest_length[0];
  boundary.rotation = 0.9;
  twist.solve(stepper.discretisation(), boundary, state);
  // In equilibrium the torques balance at every edge; all of them come from curvature.
  State turned = state;
  turned.twist_angle.assign(turned.twist_angle.size(), 0.3);
  twist.solve(stepper.discretisation(), boundary, turned);
  for (std::size_t j = 0; j < state.twist_angle.size(); ++j)
    EXPECT_NEAR(turned.twist_angle[j], state.twist_angle[j], 1e-9);
}

// J tip pre-curved by k0 on a planar arc of curvature k, held at the proximal end: GJ φ'' = EI k k0 sin φ over the
// whole wire. Snap-through begins at √(EI k k0/GJ)·L = π/2 (Reference 07). Below it the tip follows the handle
// continuously.
TEST(QuasiStaticTwist, ATurnedTipFollowsContinuouslyBelowTheSnapAndJumpsAboveIt)
{
  const auto largestJump = [](double product)
  {
    const int nodes = 80;
    const double length = 0.1;
    Wire wire = uniformWire(length, 1e-3, 4e-4, 7000.0);
    wire.sections[0].torsional_stiffness = 1e-3;
    const double curvature = product / length;
    wire.sections[0].rest_curvature = Eigen::Vector2d(0.0, -curvature);
    const Discretisation rod = discretiseUniformly(wire, nodes);
    State state;
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    state.position.push_back(x);
    for (int j = 0; j + 1 < nodes; ++j)
    {
      const double angle = curvature * rod.rest_length[j] * j;
      x += rod.rest_length[j] * Eigen::Vector3d(std::cos(angle), 0.0, -std::sin(angle));
      state.position.push_back(x);
    }
    state.twist_angle.assign(nodes - 1, 0.0);
    QuasiStaticTwist twist;
    TwistBoundary boundary;
    boundary.position = 0.5 * rod.rest_length[0];
    double previous = 0.0;
    double jump = 0.0;
    for (double hand = 0.0; hand < 7.0; hand += 0.01)
    {
      boundary.rotation = hand;
      twist.solve(rod, boundary, state);
      jump = std::max(jump, std::abs(state.twist_angle.back() - previous));
      previous = state.twist_angle.back();
    }
    EXPECT_GT(previous, 5.0);
    return jump;
  };
  EXPECT_LT(largestJump(0.9 * M_PI / 2.0), 0.2);
  EXPECT_GT(largestJump(1.3 * M_PI / 2.0), 1.0);
}

// A torque q per edge on a straight rod with a held proximal end: the torque at a node is that of all edges beyond it.
TEST(QuasiStaticTwist, ADistributedTorqueTwistsAStraightWireByItsParabola)
{
  const int nodes = 40;
  const double gj = 2e-3 / 1.3;
  const double q = 3e-5;
  const Discretisation rod = discretiseUniformly(uniformWire(0.1, 2e-3, 4e-4, 7000.0), nodes);
  const double edge = rod.rest_length[0];
  const std::vector<double> torque(nodes - 1, q);
  Boundary bench;
  bench.introducer = false;
  KktStepper stepper(rod, bench, Environment(), StepperSettings());
  State state = stepper.initialState(0.0, 0.7);
  TwistBoundary boundary;
  boundary.position = 0.5 * edge;
  boundary.rotation = 0.7;
  boundary.edge_torque = &torque;
  EXPECT_TRUE(QuasiStaticTwist::matters(rod, boundary));
  QuasiStaticTwist twist;
  twist.solve(rod, boundary, state);
  EXPECT_NEAR(state.hand_torque, -q * (nodes - 1), 1e-15);
  for (int j = 0; j + 1 < nodes; ++j)
  {
    const double carried = q * (j * (nodes - 1) - 0.5 * j * (j + 1));  // sum over the nodes 1 … j of (nodes − 1 − i)·q
    EXPECT_NEAR(state.twist_angle[j], 0.7 + carried * edge / gj, 1e-12);
  }
  // Held at the tip too, both holds share it.
  boundary.tip_held = true;
  boundary.tip_rotation = 0.7;
  twist.solve(rod, boundary, state);
  EXPECT_NEAR(state.hand_torque, -0.5 * q * (nodes - 1), 1e-12);
  EXPECT_NEAR(state.distal_torque, -0.5 * q * (nodes - 1), 1e-12);
  const double middle = q * (0.5 * (nodes - 1) * 19 - 0.5 * 19 * 20);
  EXPECT_NEAR(state.twist_angle[19], 0.7 + middle * edge / gj, 1e-12);
  EXPECT_NEAR(state.twist_angle[nodes - 2], 0.7, 1e-12);
}

// On a straight centreline rest curvature exerts no torque: the tip's angles agree with the formula of the body.
TEST(QuasiStaticTwist, TorquesAlongAPreCurvedWireOnAStraightLineTwistItLikeAStraightOne)
{
  const int nodes = 50;
  Wire straight = curvedTipWire(80.0);
  straight.sections[1].rest_curvature.setZero();
  const Discretisation with_tip = discretiseUniformly(curvedTipWire(80.0), nodes);
  const Discretisation without = discretiseUniformly(straight, nodes);
  Boundary bench;
  bench.introducer = false;
  KktStepper stepper(without, bench, Environment(), StepperSettings());
  std::vector<double> torque;
  for (int j = 0; j + 1 < nodes; ++j)
    torque.push_back(1e-5 * std::sin(0.2 * j) + 2e-6);
  for (const bool hand_held : {true, false})
    for (const bool tip_held : {true, false})
    {
      if (!hand_held && !tip_held)
        continue;
      TwistBoundary boundary;
      boundary.held = hand_held;
      boundary.position = 0.5 * without.rest_length[0];
      boundary.rotation = 0.3;
      boundary.edge_torque = &torque;
      boundary.tip_held = tip_held;
      boundary.tip_rotation = 1.1;
      boundary.tip_torque = tip_held ? 0.0 : 4e-5;
      State a = stepper.initialState(0.0, 0.3);
      State b = a;
      QuasiStaticTwist twist;
      twist.solve(with_tip, boundary, a);
      const double energy = twist.energy();
      twist.solve(without, boundary, b);
      EXPECT_NEAR(twist.energy(), energy, 1e-12);
      EXPECT_NEAR(a.hand_torque, b.hand_torque, 1e-13);
      EXPECT_NEAR(a.distal_torque, b.distal_torque, 1e-13);
      double sum = a.hand_torque + a.distal_torque + boundary.tip_torque;
      for (const double t : torque)
        sum += t;
      EXPECT_NEAR(sum, 0.0, 1e-13);
      for (int j = 0; j + 1 < nodes; ++j)
        EXPECT_NEAR(a.twist_angle[j], b.twist_angle[j], 1e-10) << "edge " << j;
    }
}

}  // namespace
}  // namespace endovascular_sim::rod
