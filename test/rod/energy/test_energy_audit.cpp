#include <gtest/gtest.h>

#include "rod/energy/energy_audit.h"
#include "test/rod/node_wall.h"
#include "test/rod/rod_fixtures.h"

// The energy audit against closed forms: falling, swinging and sliding wires.

namespace endovascular_sim::rod
{
namespace
{

constexpr double kEi = 4.9469e-5;   // N·m²
constexpr double kRadius = 1.8e-4;  // m
constexpr double kDensity = 7900.0;
constexpr double kG = 9.81;  // m/s²

Boundary freeBoundary()
{
  Boundary boundary;
  boundary.introducer = false;
  return boundary;
}

Environment heavy()
{
  Environment environment;
  environment.gravity = Eigen::Vector3d(0.0, 0.0, -kG);
  return environment;
}

double massOf(const Discretisation& rod)
{
  double sum = 0.0;
  for (const double mass : rod.mass)
    sum += mass;
  return sum;
}

/** Steps with an audit. */
EnergyBalance audited(KktStepper& stepper, State& state, const StepInput& input, int steps, double dt,
                      contact::ContactSource* wall = nullptr)
{
  EnergyAudit audit;
  stepper.setObserver(&audit);
  PhaseTimer timer;
  for (int k = 0; k < steps; ++k)
  {
    std::uint32_t pass = 0;
    stepper.step(state, input, dt, pass, wall, timer);
  }
  stepper.setObserver(nullptr);
  return audit.balance();
}

/** A pinned wire that swings down from the horizontal for half a second under weight and damping.
 *  @param damping [1/s] */
EnergyBalance swing(double dt, double damping)
{
  Boundary boundary = freeBoundary();
  boundary.proximal = EndHold::kPinned;
  Environment environment = heavy();
  environment.damping = damping;
  KktStepper stepper(discretiseUniformly(uniformWire(0.1, kEi, kRadius, kDensity), 21), boundary, environment,
                     StepperSettings());
  State state = stepper.initialState(0.0, 0.0);
  return audited(stepper, state, StepInput(), static_cast<int>(std::lround(0.5 / dt)), dt);
}

Wire preCurvedWire()
{
  Wire wire = uniformWire(0.06, kEi, kRadius, kDensity);
  wire.sections.push_back(wire.sections[0]);
  wire.sections[1].length = 0.04;
  wire.sections[1].rest_curvature = Eigen::Vector2d(30.0, 12.0);
  return wire;
}

}  // namespace

TEST(EnergyAudit, ConvertsTheWeightOfAFallingWireToKineticEnergy)
{
  KktStepper stepper(discretiseUniformly(uniformWire(0.1, kEi, kRadius, kDensity), 21), freeBoundary(), heavy(),
                     StepperSettings());
  State state = stepper.initialState(0.0, 0.0);
  const double dt = 1e-3;
  const int steps = 100;
  const EnergyBalance balance = audited(stepper, state, StepInput(), steps, dt);
  const double mass = massOf(stepper.discretisation());
  // Backward Euler: v_k = k g Δt, fall n (n + 1) g Δt²/2.
  const double kinetic = 0.5 * mass * kG * kG * steps * steps * dt * dt;
  EXPECT_NEAR(balance.kinetic, kinetic, 1e-9 * kinetic);
  EXPECT_NEAR(balance.gravity, -0.5 * mass * kG * kG * steps * (steps + 1) * dt * dt, 1e-9 * kinetic);
  EXPECT_NEAR(balance.inertia, 0.5 * mass * kG * kG * dt * dt * steps, 1e-9 * kinetic);
  EXPECT_NEAR(balance.error(), 0.0, 1e-9 * kinetic);
}

TEST(EnergyAudit, ClosesOnASwingingWireWithDamping)
{
  const EnergyBalance balance = swing(5e-4, 4.0);
  const double released = -balance.gravity;
  EXPECT_GT(released, 1e-5);
  EXPECT_GT(balance.damping, 0.3 * released);
  EXPECT_NEAR(balance.error(), 0.0, 2e-3 * released);
}

TEST(EnergyAudit, NumericalDissipationOfASwingIsOfFirstOrderInTheStep)
{
  const EnergyBalance coarse = swing(1e-3, 0.0);
  const EnergyBalance fine = swing(5e-4, 0.0);
  EXPECT_GT(coarse.numerical(), 0.0);
  EXPECT_NEAR(coarse.numerical() / fine.numerical(), 2.0, 0.4);
}

TEST(EnergyAudit, FrictionOfAWallStopsASlidingWire)
{
  const double friction = 0.2;
  const double speed = 0.1;
  KktStepper stepper(discretiseUniformly(uniformWire(0.1, kEi, kRadius, kDensity), 21), freeBoundary(), heavy(),
                     StepperSettings());
  State state = stepper.initialState(0.0, 0.0);
  PlaneWall wall(friction);
  const double mass = massOf(stepper.discretisation());
  for (Eigen::Vector3d& x : state.position)
    x.z() += kRadius - mass * kG / 21 / StepperSettings().contact_stiffness;
  PhaseTimer timer;
  for (int k = 0; k < 50; ++k)  // comes to rest on the wall
  {
    std::uint32_t pass = 0;
    stepper.step(state, StepInput(), 1e-3, pass, &wall, timer);
  }
  for (Eigen::Vector3d& velocity : state.velocity)
    velocity = Eigen::Vector3d(speed, 0.0, 0.0);
  const double begin = state.position[0].x();
  const EnergyBalance balance = audited(stepper, state, StepInput(), 200, 5e-4, &wall);
  const double kinetic = 0.5 * mass * speed * speed;
  EXPECT_NEAR(state.position[0].x() - begin, speed * speed / (2.0 * friction * kG), 1e-4);
  EXPECT_NEAR(balance.kinetic, -kinetic, 1e-6 * kinetic);
  EXPECT_NEAR(balance.wall_friction + balance.inertia, kinetic, 1e-2 * kinetic);
  EXPECT_NEAR(balance.error(), 0.0, 1e-2 * kinetic);
}

// Backward Euler: Σ m (v_k − v_{k−1})·v_k = ½ m v_n² + Σ ½ m |v_k − v_{k−1}|².
TEST(EnergyAudit, TheWorkOfAStreamOnAFreeWireIsItsKineticEnergyAndTheLossOfTheIntegration)
{
  KktStepper stepper(discretiseUniformly(uniformWire(0.1, kEi, kRadius, kDensity), 21), freeBoundary(), Environment(),
                     StepperSettings());
  State state = stepper.initialState(0.0, 0.0);
  const Eigen::Vector3d stream(0.1, 0.3, -0.2);
  const double per_length = 0.15;
  const double dt = 1e-3;
  StepInput input;
  input.drags = uniformStream(stepper.discretisation(), per_length * Eigen::Matrix3d::Identity(), stream);
  const EnergyBalance balance = audited(stepper, state, input, 20, dt);
  const double mass = massOf(stepper.discretisation());
  const double decay = 1.0 / (1.0 + 0.1 * per_length * dt / mass);
  double loss = 0.0;
  for (int k = 0; k < 20; ++k)
    loss += 0.5 * mass * stream.squaredNorm() * std::pow(std::pow(decay, k) * (1.0 - decay), 2);
  const double kinetic = 0.5 * mass * stream.squaredNorm() * std::pow(1.0 - std::pow(decay, 20), 2);
  EXPECT_NEAR(balance.kinetic, kinetic, 1e-7 * kinetic);
  EXPECT_NEAR(balance.stream, kinetic + loss, 1e-7 * kinetic);
  EXPECT_NEAR(balance.iteration, 0.0, 1e-7 * kinetic);
  EXPECT_NEAR(balance.error(), 0.0, 1e-7 * kinetic);
}

/** A wire that is pushed 5 mm out of the introducer across a stream, which bends it. */
EnergyBalance pushIntoAStream(double dt)
{
  KktStepper stepper(discretiseUniformly(uniformWire(0.15, kEi, kRadius, kDensity), 76), Boundary(), Environment(),
                     StepperSettings());
  State state = stepper.initialState(0.06, 0.0);
  StepInput input;
  input.inserted_length = 0.06;
  input.drags = uniformStream(stepper.discretisation(), Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.0, 0.5, 0.0));
  EnergyAudit audit;
  stepper.setObserver(&audit);
  const int steps = static_cast<int>(std::lround(0.2 / dt));
  for (int k = 0; k < steps; ++k)
  {
    input.inserted_length += 0.025 * dt;
    EXPECT_TRUE(advanceFreely(stepper, state, input, dt).solved);
  }
  return audit.balance();
}

TEST(EnergyAudit, ClosesOnAWireThatAStreamBendsWhileItIsPushed)
{
  const EnergyBalance balance = pushIntoAStream(5e-4);
  EXPECT_GT(balance.bending, 1e-5);
  EXPECT_GT(balance.stream, 0.9 * balance.bending);  // the stream bends the wire, and the hand only guides it
  EXPECT_LT(std::abs(balance.iteration), 1e-3 * balance.stream);
  EXPECT_LT(std::abs(balance.error()), 1e-3 * balance.stream);
}

TEST(EnergyAudit, StoresTheWorkOfATurningHandInAWireHeldAtBothEnds)
{
  Boundary boundary = freeBoundary();
  boundary.proximal = boundary.distal = EndHold::kClamped;
  boundary.distal_twist_held = true;
  const double length = 0.1;  // between the clamps
  const int nodes = 41;
  const Wire wire = uniformWire(heldLength(length, nodes, EndHold::kClamped), kEi, kRadius, kDensity);
  KktStepper stepper(discretiseUniformly(wire, nodes), boundary, Environment(), StepperSettings());
  State state = stepper.initialState(0.0, 0.0);
  EnergyAudit audit;
  stepper.setObserver(&audit);
  PhaseTimer timer;
  StepInput input;
  const double turn = 0.5;  // rad: below the torque of buckling
  const int steps = 500;
  for (int k = 1; k <= steps; ++k)
  {
    std::uint32_t pass = 0;
    input.rotation = turn * k / steps;
    stepper.step(state, input, 1e-3, pass, nullptr, timer);
  }
  const EnergyBalance& balance = audit.balance();
  const double stored = 0.5 * wire.sections[0].torsional_stiffness / length * turn * turn;
  EXPECT_NEAR(balance.twist, stored, 1e-6 * stored);
  EXPECT_NEAR(balance.twisting, stored / steps, 1e-6 * stored);  // the torque at the end of a step times its turn
  EXPECT_NEAR(balance.turnover, balance.turn + stored, 1e-6 * stored);
  EXPECT_NEAR(balance.error(), 0.0, 1e-6 * stored);
}

/** A wire that is pushed through the introducer against a pin, and buckles, from 1.05 to 1.5 times the distance. */
EnergyBalance pushAgainstAPin(double dt)
{
  const double length = 0.1;
  Boundary boundary;
  boundary.distal = EndHold::kPinned;
  Environment environment;
  environment.damping = 30.0;
  KktStepper stepper(discretiseUniformly(uniformWire(0.25, kEi, kRadius, kDensity), 101), boundary, environment,
                     StepperSettings());
  State state = stepper.initialState(length, 0.0);
  StepInput input;
  input.inserted_length = length;
  input.forces.push_back({80, Eigen::Vector3d(0.0, 1e-5, 0.0)});
  PhaseTimer timer;
  EnergyAudit audit;
  while (input.inserted_length < 1.5 * length)
  {
    if (input.inserted_length > 1.05 * length)
      stepper.setObserver(&audit);
    input.inserted_length += 0.02 * dt;
    std::uint32_t pass = 0;
    stepper.step(state, input, dt, pass, nullptr, timer);
  }
  return audit.balance();
}

// The hand supplies the energy of the wire. Without the configurational force it would supply three times as much.
TEST(EnergyAudit, ClosesWhileAWireBentAtTheIntroducersMouthIsPushedIn)
{
  const EnergyBalance coarse = pushAgainstAPin(1e-3);
  const EnergyBalance fine = pushAgainstAPin(5e-4);
  EXPECT_NEAR(coarse.push, coarse.bending + coarse.guide, 0.02 * coarse.push);
  EXPECT_LT(std::abs(coarse.error()), 2e-3 * coarse.push);
  EXPECT_LT(std::abs(fine.error()), 0.7 * std::abs(coarse.error()) + 1e-5 * fine.push);
}

// A curved tip without contact: its energy at the mouth falls from ½EIκ̄² per length to zero.
TEST(EnergyAudit, ACurvedTipPushesItselfOutOfTheIntroducerAndIsWithdrawnWithItsBendingEnergy)
{
  const double curvature = 60.0;
  Wire wire = uniformWire(0.2, kEi, kRadius, kDensity);
  wire.sections.push_back(wire.sections[0]);
  wire.sections[1].length = 0.03;
  wire.sections[1].rest_curvature = Eigen::Vector2d(0.0, curvature);
  Environment environment;
  environment.damping = 400.0;
  KktStepper stepper(discretiseUniformly(wire, 116), Boundary(), environment, StepperSettings());
  const double exact = -0.5 * kEi * curvature * curvature;
  State state = stepper.initialState(2e-3, 0.0);
  StepInput input;
  input.inserted_length = 2e-3;
  EnergyAudit audit;
  stepper.setObserver(&audit);
  PhaseTimer timer;
  const double dt = 1e-3;
  std::vector<double> work;
  for (const double speed : {5e-3, -5e-3})
  {
    double sum = 0.0;
    int count = 0;
    double push = -audit.balance().push;
    for (int k = 0; k < 4000; ++k)
    {
      input.inserted_length += speed * dt;
      std::uint32_t pass = 0;
      stepper.step(state, input, dt, pass, nullptr, timer);
      if (input.inserted_length < 6e-3 || input.inserted_length > 18e-3)  // six edges
        continue;
      sum += state.hand_force;
      ++count;
    }
    push += audit.balance().push;
    EXPECT_NEAR(sum / count, exact, 0.03 * std::abs(exact)) << speed;
    work.push_back(push);
  }
  EXPECT_LT(work[0], 0.0);
  EXPECT_NEAR(work[1], -work[0], 5e-3 * work[1]);
  EXPECT_LT(std::abs(audit.balance().error()), 1e-3 * audit.balance().turnover);
}

TEST(EnergyAudit, PotentialEnergyAtRelaxedAnglesEqualsTheStepper)
{
  Boundary boundary = freeBoundary();
  boundary.proximal = EndHold::kClamped;
  const Discretisation rod = discretiseUniformly(preCurvedWire(), 41);
  KktStepper stepper(rod, boundary, heavy(), StepperSettings());
  State state = stepper.initialState(0.0, 0.7);
  StepInput input;
  input.rotation = 0.7;
  PhaseTimer timer;
  for (int k = 0; k < 60; ++k)
  {
    std::uint32_t pass = 0;
    stepper.step(state, input, 1e-3, pass, nullptr, timer);
  }
  const Energy relaxed = stepper.energy(state);
  const BoundaryConditions conditions(rod, boundary);
  QuasiStaticTwist twist;
  twist.solve(rod, conditions.twistBoundary(state, 0.0), state);
  PotentialEnergy energy;
  addElasticEnergy(rod, conditions.twistBoundary(state, 0.0), state, state.twist_angle, energy);
  EXPECT_GT(relaxed.bending, 1e-6);
  EXPECT_GT(relaxed.twist, 1e-12);
  EXPECT_NEAR(energy.bending, relaxed.bending, 1e-9 * relaxed.bending);
  EXPECT_NEAR(energy.twist, relaxed.twist, 1e-9 * relaxed.bending);
}

TEST(EnergyAudit, TrajectoryHasTheSameBitsWithAndWithout)
{
  std::vector<std::uint64_t> hashes;
  for (const bool with_audit : {false, true})
  {
    Boundary boundary = freeBoundary();
    boundary.proximal = EndHold::kClamped;
    KktStepper stepper(discretiseUniformly(preCurvedWire(), 41), boundary, heavy(), StepperSettings());
    State state = stepper.initialState(0.0, 0.0);
    PlaneWall wall(0.2);
    for (Eigen::Vector3d& x : state.position)
      x.z() += 2e-3;
    EnergyAudit audit;
    if (with_audit)
      stepper.setObserver(&audit);
    PhaseTimer timer;
    StepInput input;
    for (int k = 1; k <= 200; ++k)
    {
      std::uint32_t pass = 0;
      input.rotation = 2e-3 * k;
      stepper.step(state, input, 1e-3, pass, &wall, timer);
    }
    EXPECT_EQ(audit.balance().turnover > 0.0, with_audit);
    hashes.push_back(state.hash());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

}  // namespace endovascular_sim::rod
