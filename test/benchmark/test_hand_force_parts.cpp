#include "rod/boundary/hand_force_parts.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "benchmark/reference/smooth_walls.h"
#include "rod/boundary/boundary_conditions.h"
#include "rod/contact/wall_friction.h"
#include "rod/kkt/kkt_stepper.h"
#include "test/rod/kkt_stepper_peer.h"
#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::benchmark
{
namespace
{

using Eigen::Vector3d;

constexpr double kDt = 1e-3;
constexpr double kStiffness = 5e-5;  // N·m²
constexpr double kRadius = 1.8e-4;
constexpr double kDensity = 7900.0;
constexpr double kGravity = 9.81;
const double kLineDensity = kDensity * M_PI * kRadius * kRadius;

/** Wall with a friction coefficient of its own. */
class RoughWall : public contact::ContactSource
{
public:
  RoughWall(contact::ContactSource& wall, double friction) : wall_(wall), friction_(friction) {}

  void detect(const contact::Query& query, contact::ContactSet& set) override
  {
    wall_.detect(query, set);
    for (contact::Feature& feature : set.features)
      feature.friction = friction_;
  }

  void freeDistances(const contact::Query& query, double wanted, contact::ContactSet& set) override
  {
    wall_.freeDistances(query, wanted, set);
  }

private:
  contact::ContactSource& wall_;
  double friction_;
};

/** Wire that is pushed through an introducer at the origin, along x. */
struct PushedWire
{
  PushedWire(double length, int nodes, const rod::Environment& environment, double inserted)
    : stepper(rod::discretiseUniformly(rod::uniformWire(length, kStiffness, kRadius, kDensity), nodes), rod::Boundary(),
              environment, rod::StepperSettings()),
      state(stepper.initialState(inserted, 0.0))
  {
    input.inserted_length = inserted;
  }

  void push(double travel, contact::ContactSource* wall)
  {
    before = state;
    input.inserted_length += travel;
    std::uint32_t pass = 0;
    ASSERT_TRUE(stepper.step(state, input, kDt, pass, wall, timer).solved);
    ++input.step;
  }

  rod::KktStepper stepper;
  rod::State state;
  rod::State before;
  rod::StepInput input;
  PhaseTimer timer;
};

/** Parts recomputed from the state after a step: energy gradient, forces of wall, friction and guide, velocities. */
rod::HandForceParts recomputedParts(PushedWire& wire)
{
  const rod::State& state = wire.state;
  const rod::Discretisation& rod = wire.stepper.discretisation();
  const rod::Boundary boundary;
  const rod::BoundaryConditions held(rod, boundary);
  int last_held = state.first_node - 1;
  while (held.isPrescribed(last_held + 1, state))
    ++last_held;
  std::vector<Vector3d> slide;
  rod::slideAlongItself(state.position, std::vector<Vector3d>(state.position.size(), Vector3d::Zero()),
                        state.first_node, last_held, boundary.direction, slide);
  const std::vector<Vector3d> gradient = rod::KktStepperPeer::elasticGradient(wire.stepper, state, wire.input);
  std::vector<Vector3d> guide(state.position.size(), Vector3d::Zero());
  rod::IntroducerGuide(boundary).forEachEdge(rod, state,
                                             [&guide](int edge, const rod::GuidedEdge& term)
                                             {
                                               guide[edge] += term.gradient[0];
                                               guide[edge + 1] += term.gradient[1];
                                             });
  rod::HandForceParts parts;
  parts.bending = parts.friction = parts.inertia = parts.drag = parts.load = 0.0;
  for (int i = state.first_node; i < rod.nodes(); ++i)
  {
    parts.bending += slide[i].dot(gradient[i] - state.wall_force[i] + guide[i]);
    parts.friction -= slide[i].dot(rod::frictionForce(state, i, rod::StepperSettings().friction_slip));
    if (!wire.input.drags.empty())
      parts.drag -= slide[i].dot(wire.input.drags[i].coefficient * (wire.input.drags[i].stream - state.velocity[i]));
    if (i > last_held)
      parts.inertia += rod.mass[i] * slide[i].dot(state.velocity[i] - wire.before.velocity[i]) / kDt;
  }
  return parts;
}

}  // namespace

TEST(SlideAlongItself, KeepsTheLengthOfEveryEdge)
{
  std::vector<Vector3d> x = {{0, 0, 0}, {1, 0, 0}, {1.9, 0.2, 0.1}, {2.5, 0.9, -0.3}, {2.4, 1.8, 0.1}};
  const std::vector<Vector3d> none(x.size(), Vector3d::Zero());
  std::vector<Vector3d> slide;
  rod::slideAlongItself(x, none, 0, 1, Vector3d::UnitX(), slide);
  EXPECT_EQ(slide[0], Vector3d::UnitX());
  EXPECT_EQ(slide[1], Vector3d::UnitX());
  for (std::size_t j = 0; j + 1 < x.size(); ++j)
    EXPECT_NEAR((x[j + 1] - x[j]).dot(slide[j + 1] - slide[j]), 0.0, 1e-14) << j;
}

TEST(HandForceParts, RecomputedFromTheStepAddUpToTheHandForceInABentTube)
{
  BentTube tube(1e-3, 0.02, 0.03, 0.5 * M_PI);
  RoughWall wall(tube, 0.2);
  PushedWire wire(0.16, 161, rod::Environment(), 0.02);
  double whole = 0.0, difference = 0.0, bending = 0.0, friction = 0.0;
  for (int k = 0; k < 2000; ++k)
  {
    wire.push(0.04e-3, &wall);
    const rod::HandForceParts recomputed = recomputedParts(wire);
    const rod::HandForceParts& parts = wire.state.hand_parts;
    EXPECT_NEAR(parts.sum(), wire.state.hand_force, 1e-12);
    whole += wire.state.hand_force;
    difference += recomputed.sum() - wire.state.hand_force;
    bending += recomputed.bending - parts.bending;
    friction += recomputed.friction - parts.friction;
  }
  // Friction uses the normal force of the previous solve, which equals that at the end of the step on average only.
  EXPECT_GT(whole / 2000, 5e-3);
  EXPECT_LT(std::abs(difference), 0.01 * whole);
  EXPECT_LT(std::abs(bending), 0.01 * whole);
  EXPECT_LT(std::abs(friction), 0.01 * whole);
}

TEST(HandForceParts, RecomputedFromTheStepAddUpToTheHandForceInAStream)
{
  PushedWire wire(0.16, 161, rod::Environment(), 0.06);
  wire.input.drags =
      rod::uniformStream(wire.stepper.discretisation(), 0.5 * Eigen::Matrix3d::Identity(), Vector3d(-0.1, 0.5, 0.0));
  double whole = 0.0, difference = 0.0, bending = 0.0, dragged = 0.0;
  for (int k = 0; k < 400; ++k)
  {
    wire.push(0.02e-3, nullptr);
    const rod::HandForceParts recomputed = recomputedParts(wire);
    const rod::HandForceParts& parts = wire.state.hand_parts;
    EXPECT_NEAR(parts.sum(), wire.state.hand_force, 1e-12);
    whole += std::abs(parts.bending) + std::abs(parts.drag);
    difference += std::abs(recomputed.sum() - wire.state.hand_force);
    bending += std::abs(recomputed.bending - parts.bending);
    dragged += std::abs(recomputed.drag - parts.drag);
  }
  EXPECT_GT(whole / 400, 2e-3);
  EXPECT_LT(difference, 0.01 * whole);
  EXPECT_LT(bending, 0.01 * whole);
  EXPECT_LT(dragged, 0.01 * whole);
}

// Exact: ½EIκ² while the tip is in the bend.
TEST(HandForceParts, WithoutFrictionEqualTheBendingEnergyEnteringTheBend)
{
  constexpr double kBend = 0.03;
  BentTube tube(0.01 * kBend, 0.03, kBend, 0.5 * M_PI);
  PushedWire wire(0.16, 161, rod::Environment(), 0.03);
  while (wire.input.inserted_length < 0.05)
    wire.push(0.05e-3, &tube);
  const double before = wire.stepper.energy(wire.state).bending;
  double work = 0.0;
  double others = 0.0;
  for (int k = 0; k < 200; ++k)
  {
    wire.push(0.05e-3, &tube);
    work += 0.05e-3 * wire.state.hand_parts.bending;
    others += 0.05e-3 * std::abs(wire.state.hand_force - wire.state.hand_parts.bending);
  }
  EXPECT_NEAR(work, wire.stepper.energy(wire.state).bending - before, 0.01 * work);
  EXPECT_NEAR(work / 0.01, 0.5 * kStiffness / (kBend * kBend), 0.05 * work / 0.01);
  EXPECT_LT(others, 0.02 * work);
}

TEST(HandForceParts, EqualFrictionAndWeightOnAStraightRamp)
{
  constexpr double kSlope = 0.4;  // rad
  constexpr double kFriction = 0.3;
  rod::Environment environment;
  environment.gravity = kGravity * Vector3d(-std::sin(kSlope), -std::cos(kSlope), 0.0);
  FlatChannel floor(0.01);
  RoughWall wall(floor, kFriction);
  PushedWire wire(0.16, 161, environment, 0.06);
  for (int k = 0; k < 300; ++k)
    wire.push(0.02e-3, &wall);
  const rod::HandForceParts& parts = wire.state.hand_parts;
  const double weight = kLineDensity * kGravity * wire.state.inserted_length;
  const rod::State& state = wire.state;
  double pressed = 0.0;
  for (const Vector3d& force : state.wall_force)
    pressed += force.norm();
  EXPECT_NEAR(parts.friction, kFriction * pressed, 0.01 * parts.friction);
  EXPECT_GT(pressed, 0.99 * std::cos(kSlope) *
                         weight);  // the guide is soft near the mouth, so the wall supports a part of the weight there
  EXPECT_LT(pressed, std::cos(kSlope) * weight * (1.0 + rod::Boundary().guide_length / state.inserted_length));
  double heavy = 0.0;
  for (int i = state.first_node; i < 161; ++i)
    heavy += wire.stepper.discretisation().mass[i] * kGravity;
  EXPECT_NEAR(parts.load, std::sin(kSlope) * heavy, 1e-3 * heavy);
  EXPECT_NEAR(parts.bending, 0.0, 0.01 * wire.state.hand_force);
  EXPECT_NEAR(parts.inertia, 0.0, 0.01 * wire.state.hand_force);
}

TEST(HandForceParts, EqualTheInertiaOfAnAcceleratedFreeWire)
{
  constexpr double kAcceleration = 2.0;  // m/s²
  PushedWire wire(0.16, 161, rod::Environment(), 0.06);
  double speed = 0.0;
  for (int k = 0; k < 50; ++k)
  {
    speed += kAcceleration * kDt;
    wire.push(speed * kDt, nullptr);
  }
  const double mass = kLineDensity * (wire.state.inserted_length + rod::Boundary().guide_length);
  EXPECT_NEAR(wire.state.hand_parts.inertia, mass * kAcceleration, 0.02 * mass * kAcceleration);
  EXPECT_NEAR(wire.state.hand_force, wire.state.hand_parts.inertia, 1e-6 * wire.state.hand_force);
}

TEST(HandForceParts, EqualTheDragOfAFreeWireInAFluidAtConstantSpeed)
{
  rod::Environment environment;
  environment.damping = 5.0;
  PushedWire wire(0.16, 161, environment, 0.06);
  for (int k = 0; k < 400; ++k)
    wire.push(0.05e-3, nullptr);
  const rod::HandForceParts& parts = wire.state.hand_parts;
  double mass = 0.0;
  for (int i = wire.state.first_node; i < 161; ++i)
    mass += wire.stepper.discretisation().mass[i];
  EXPECT_NEAR(parts.drag, 5.0 * mass * 0.05, 1e-6 * parts.drag);
  EXPECT_NEAR(parts.drag, wire.state.hand_force, 1e-3 * parts.drag);
}

}  // namespace endovascular_sim::benchmark
