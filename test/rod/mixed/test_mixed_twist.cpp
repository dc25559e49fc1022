#include "rod/mixed/mixed_twist.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "benchmark/reference/mixed_statics.h"
#include "rod/mixed/mixed_stepper.h"
#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

using Eigen::Vector3d;

/** Rod of EI = 1, clamped at the origin along x, with d1 along y. */
MixedRod unitRod(int edges, double length, double twist_flexibility, double curvature)
{
  MixedEdge edge;
  edge.length = length / edges;
  edge.flexibility = 1.0;
  edge.twist_flexibility = twist_flexibility;
  edge.material_curvature = Eigen::Vector2d(curvature, 0.0);
  return MixedRod(std::vector<MixedEdge>(static_cast<std::size_t>(edges), edge), {EndHold::kClamped, Vector3d::UnitX()},
                  {EndHold::kFree, Vector3d::UnitX()});
}

State equilibrium(MixedRod& rod, const Vector3d& tip_force, const TwistBoundary& twist)
{
  State state = rod.straight(Vector3d::Zero(), Vector3d::UnitX());
  EXPECT_TRUE(benchmark::solveStatics(rod, {{rod.nodes() - 1, tip_force}}, benchmark::StaticsSettings(), state, &twist)
                  .converged);
  return state;
}

double order(double coarse, double fine)
{
  return std::log2(coarse / fine);
}

// 45° arc, GJ = EI and GJ = EI/1.3, loaded out of its plane with FR²/EI = 3.6.
TEST(MixedTwist, ArcBentOutOfItsPlaneConvergesWithFourthOrder)
{
  const Vector3d isotropic(0.5877968539120596, 0.2224503474206913, 0.4018828383798087);
  const Vector3d soft(0.5839083535454666, 0.2202658389805687, 0.40651206016496405);
  for (const auto& [flexibility, exact] : {std::make_pair(1.0, isotropic), std::make_pair(1.3, soft)})
  {
    const auto error = [flexibility = flexibility, exact = exact](int edges)
    {
      MixedRod rod = unitRod(edges, M_PI_4, flexibility, 1.0);
      return (equilibrium(rod, Vector3d(0.0, 0.0, 3.6), TwistBoundary()).position.back() - exact).norm();
    };
    const double middle = error(12);
    EXPECT_NEAR(order(error(6), middle), 4.0, 0.2);
    EXPECT_NEAR(order(middle, error(24)), 4.0, 0.2);
    EXPECT_LT(error(24), 3e-8);
  }
}

/** A stiff, slightly curved shaft and a soft, helical tip: EI 4 : 1, GJ 3 : 1/1.3, curvatures about both axes. */
MixedRod steppedRod(int edges)
{
  MixedEdge shaft;
  shaft.length = 1.0 / edges;
  shaft.flexibility = 0.25;
  shaft.twist_flexibility = 1.0 / 3.0;
  shaft.material_curvature = Eigen::Vector2d(0.5, 0.0);
  MixedEdge tip = shaft;
  tip.flexibility = 1.0;
  tip.twist_flexibility = 1.3;
  tip.material_curvature = Eigen::Vector2d(1.5, 0.6);
  std::vector<MixedEdge> all(static_cast<std::size_t>(edges), shaft);
  std::fill(all.begin() + edges / 2, all.end(), tip);
  return MixedRod(all, {EndHold::kClamped, Vector3d::UnitX()}, {EndHold::kFree, Vector3d::UnitX()});
}

const Vector3d kSteppedForce(-0.4, 0.7, 2.0);

// Reference: Kirchhoff's equations as an initial value problem (DOP853, 1e-13) shot to the moment at the tip, without
// and with a torque of 0.8 there.
TEST(MixedTwist, SectionJumpInAPreCurvedWireBentInSpaceKeepsFourthOrder)
{
  const Vector3d without(0.8034067498955091, 0.37613930898254205, 0.25666686346737366);
  const Vector3d with(0.785418571027844, 0.42416071079601386, 0.20639915293063635);
  for (const auto& [torque, exact] : {std::make_pair(0.0, without), std::make_pair(0.8, with)})
  {
    TwistBoundary twist;
    twist.tip_torque = torque;
    const auto error = [&twist, exact = exact](int edges)
    {
      MixedRod rod = steppedRod(edges);
      return (equilibrium(rod, kSteppedForce, twist).position.back() - exact).norm();
    };
    const double middle = error(16);
    EXPECT_NEAR(order(error(8), middle), 4.0, 0.2);
    EXPECT_NEAR(order(middle, error(32)), 4.0, 0.2);
    EXPECT_LT(error(32), 1e-7);
  }
}

// Reference: the same equations; clamped with d1 along y, curvature 1.5, GJ = EI/1.3, a dead load (0, −1, 3) per
// length.
TEST(MixedTwist, DistributedLoadOnACurvedWireConvergesWithFourthOrder)
{
  const Vector3d exact(0.673680026732212, 0.511189199363609, 0.3454880827484475);
  const auto error = [&exact](int edges)
  {
    MixedRod rod = unitRod(edges, 1.0, 1.3, 1.5);
    for (int j = 0; j < edges; ++j)
      rod.edge(j).load = Vector3d(0.0, -1.0, 3.0);
    return (equilibrium(rod, Vector3d::Zero(), TwistBoundary()).position.back() - exact).norm();
  };
  const double middle = error(12);
  EXPECT_NEAR(order(error(6), middle), 4.0, 0.2);
  EXPECT_NEAR(order(middle, error(24)), 4.0, 0.2);
}

// The moment at every node is that of the tip's force and torque, whatever the number of nodes.
TEST(MixedTwist, MomentIsBalancedExactlyAtEveryNode)
{
  TwistBoundary twist;
  twist.tip_torque = 0.8;
  MixedRod rod = steppedRod(8);
  State state = equilibrium(rod, kSteppedForce, twist);
  MixedTwist relaxed;
  relaxed.relax(rod, twist, state);
  EXPECT_NEAR(relaxed.moment(8).norm(), 0.8, 1e-12);
  for (int i = 0; i < 8; ++i)
  {
    const Vector3d arm = state.position.back() - state.position[i];
    EXPECT_LT((relaxed.moment(i) - relaxed.moment(8) - arm.cross(kSteppedForce)).norm(), 1e-9);
  }
}

// The forces are not derivatives of an energy of the discrete rod. The derivatives of the computed energy by load and
// rotation of the handle agree with displacement and torque to fourth order.
TEST(MixedTwist, EnergyChangesByTheWorkOfLoadAndHandToFourthOrder)
{
  const auto energy = [](int edges, double rotation, double share, double& torque, double& tip)
  {
    TwistBoundary twist;
    twist.rotation = rotation;
    MixedRod rod = steppedRod(edges);
    State state = equilibrium(rod, share * kSteppedForce, twist);
    MixedTwist relaxed;
    relaxed.relax(rod, twist, state);
    torque = state.hand_torque;
    tip = kSteppedForce.dot(state.position.back());
    const Energy elastic = relaxed.energy(state);
    return elastic.bending + elastic.twist - share * tip;
  };
  const auto errors = [&energy](int edges)
  {
    const double step = 1e-3;
    double torque = 0.0, tip = 0.0, unused = 0.0;
    energy(edges, 0.7, 1.0, torque, tip);
    const auto derivative = [&](double turn, double load)
    {
      const auto at = [&](double k) { return energy(edges, 0.7 + k * turn, 1.0 + k * load, unused, unused); };
      return (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * step);
    };
    return std::make_pair(std::abs(derivative(step, 0.0) - torque), std::abs(derivative(0.0, step) + tip));
  };
  const auto coarse = errors(8);
  const auto fine = errors(16);
  EXPECT_GT(order(coarse.first, fine.first), 3.5);
  EXPECT_GT(order(coarse.second, fine.second), 3.5);
  EXPECT_LT(fine.first, 1e-5);
  EXPECT_LT(fine.second, 1e-4);
}

// A quarter circle loaded in its plane, here with relaxed frames.
TEST(MixedTwist, ArcBentInItsPlaneKeepsFourthOrder)
{
  const Vector3d exact(0.804105101290247, 0.4818706970436423, 0.0);
  const auto error = [&exact](int edges)
  {
    MixedRod rod = unitRod(edges, 1.0, 1.3, M_PI_2);
    return (equilibrium(rod, Vector3d(0.0, -1.0, 0.0), TwistBoundary()).position.back() - exact).norm();
  };
  EXPECT_NEAR(std::log2(error(8) / error(16)), 4.0, 0.2);
}

// Reference: Kirchhoff's equations, as for the section jump.
TEST(MixedTwist, TorqueAtAFreeTipConvergesWithFourthOrder)
{
  const Vector3d exact(0.6252851993089596, -0.5656816504630502, 0.4073078069432715);
  TwistBoundary twist;
  twist.tip_torque = 1.0;
  const auto error = [&twist, &exact](int edges, double& torque)
  {
    MixedRod rod = unitRod(edges, 1.0, 1.3, 0.0);
    const State state = equilibrium(rod, Vector3d(-1.0, -3.0, 1.0), twist);
    torque = std::abs(state.hand_torque + 1.0);
    return (state.position.back() - exact).norm();
  };
  double coarse_torque, fine_torque;
  const double coarse = error(8, coarse_torque);
  const double fine = error(16, fine_torque);
  EXPECT_NEAR(order(coarse, fine), 4.0, 0.2);
  EXPECT_LT(coarse_torque, 1e-4);  // the moments balance about the clamp's axis, the torque acts about the tip's
  EXPECT_GT(order(coarse_torque, fine_torque), 3.5);
}

TEST(MixedTwist, StraightWireTwistsAsALinearSpring)
{
  TwistBoundary twist;
  twist.tip_torque = 0.2;
  twist.rotation = 0.7;
  MixedRod rod = unitRod(10, 1.0, 1.3, 0.0);
  const State state = equilibrium(rod, Vector3d::Zero(), twist);
  for (int j = 0; j < 10; ++j)
    EXPECT_NEAR(state.twist_angle[j], 0.7 + 0.2 * 1.3 * (j + 0.5) / 10, 1e-12);
}

// Null test: the unloaded shape of a pre-curved wire turns rigidly with the handle.
TEST(MixedTwist, UnloadedCurvedWireTurnsWithTheHandleWithoutTorque)
{
  TwistBoundary twist;
  twist.rotation = M_PI_2;
  MixedRod rod = unitRod(12, 1.0, 1.3, 2.0);
  const State state = equilibrium(rod, Vector3d::Zero(), twist);
  EXPECT_LT((state.position.back() - Vector3d(std::sin(2.0) / 2.0, 0.0, (1.0 - std::cos(2.0)) / 2.0)).norm(), 3e-5);
  EXPECT_NEAR(state.hand_torque, 0.0, 1e-9);
}

TEST(MixedTwist, MovingWireComesToRestAtTheStaticShape)
{
  Wire wire = uniformWire(M_PI_4, 1.0, 0.02, 1000.0);
  wire.sections[0].torsional_stiffness = 1.0;
  wire.sections[0].rest_curvature = Eigen::Vector2d(1.0, 0.0);
  Boundary boundary;
  boundary.introducer = false;
  boundary.proximal = EndHold::kClamped;
  Environment environment;
  environment.damping = 5.0;
  MixedStepper stepper(wire, discretiseUniformly(wire, 13), boundary, environment, StepperSettings());
  State state = stepper.initialState(0.0, 0.0);
  StepInput input;
  input.forces.push_back({12, Vector3d(0.0, 0.0, 3.6)});
  PhaseTimer timer;
  for (int k = 0; k < 400; ++k)
  {
    std::uint32_t pass = 0;
    ASSERT_TRUE(stepper.step(state, input, 0.05, pass, nullptr, timer).solved);
  }
  MixedRod rod = unitRod(12, M_PI_4, 1.0, 1.0);
  const State rest = equilibrium(rod, Vector3d(0.0, 0.0, 3.6), TwistBoundary());
  EXPECT_LT((state.position.back() - rest.position.back()).norm(), 1e-8);
  EXPECT_NEAR(state.hand_torque, rest.hand_torque, 1e-7);
  EXPECT_GT(stepper.energy(state).twist, 0.0);
}

/** Largest difference between the assembled second derivatives and those of the gradient by finite differences, the
 *  twist relaxed for each: rows of moments by positions, of positions by positions, and both by moments. Relative to
 * the blocks' scales 1/h, EI/h³, and h/EI or 1/h. */
std::array<double, 3> jacobianErrors(int edges)
{
  MixedRod rod = steppedRod(edges);
  const TwistBoundary twist;
  const State rest = equilibrium(rod, kSteppedForce, twist);
  const int size = rod.size(rest);
  const auto assembled = [&](const State& at, std::vector<double>& gradient, MixedRod::Matrix& hessian)
  {
    State state = at;
    MixedTwist relaxed;
    for (int pass = 0; pass < 3; ++pass)
      relaxed.relax(rod, twist, state);
    gradient.assign(static_cast<std::size_t>(size), 0.0);
    hessian.reset(size);
    rod.assemble(state, gradient, hessian);
    relaxed.assemble(rod, state, gradient, hessian);
  };
  std::vector<double> gradient;
  MixedRod::Matrix hessian, unused;
  assembled(rest, gradient, hessian);
  std::array<double, 3> worst{};
  const double h = 1.0 / edges;
  for (int i = 2; i < edges; ++i)
    for (int axis = 0; axis < 3; ++axis)
      for (const bool by_moment : {false, true})
      {
        std::vector<double> plus, minus;
        State state = rest;
        double& value = by_moment ? state.moment[i][axis] : state.position[i][axis];
        const double middle = value;
        value = middle + 1e-6;
        assembled(state, plus, unused);
        value = middle - 1e-6;
        assembled(state, minus, unused);
        const int col = (by_moment ? rod.momentRow(rest, i) : rod.positionRow(rest, i)) + axis;
        for (int node = i - 1; node <= std::min(edges - 1, i + 1); ++node)
          for (const bool of_moment : {false, true})
            for (int other = 0; other < 3; ++other)
            {
              const int row = (of_moment ? rod.momentRow(rest, node) : rod.positionRow(rest, node)) + other;
              const double exact = (plus[row] - minus[row]) / 2e-6;
              const double found = hessian.at(std::max(row, col), std::min(row, col));
              if (!by_moment && of_moment)
                worst[0] = std::max(worst[0], h * std::abs(found - exact));
              if (!by_moment && !of_moment)
                worst[1] = std::max(worst[1], h * h * h * std::abs(found - exact));
              if (by_moment)
                worst[2] = std::max(worst[2], (of_moment ? 1.0 / h : h) * std::abs(found - exact));
            }
      }
  return worst;
}

TEST(MixedTwist, SecondDerivativesEqualThoseOfTheGradientUpToTermsThatVanishWithTheEdgeLength)
{
  const auto coarse = jacobianErrors(16);
  const auto fine = jacobianErrors(32);
  EXPECT_LT(coarse[0], 6e-3);  // 0.04 without the rotation of the rest curvature with its chord
  for (int block = 0; block < 3; ++block)
  {
    EXPECT_LT(coarse[block], 0.12);
    EXPECT_GT(order(coarse[block], fine[block]), 0.8);
  }
}

// A J of 3 mm, opened straight, on edges that turn by 0.7 rad each: it snaps back within few steps, which the trust
// region cuts short, and comes to rest as a semicircle.
TEST(MixedTwist, AStraightenedCoarseJSnapsBackToASemicircle)
{
  Wire wire = uniformWire(0.01, 5e-6, 4.445e-4, 6450.0);
  wire.sections[0].torsional_stiffness = 5e-6 / 1.3;
  wire.sections.push_back(wire.sections[0]);
  wire.sections[1].length = 0.003 * M_PI;
  wire.sections[1].rest_curvature = Eigen::Vector2d(1.0 / 0.003, 0.0);
  Boundary boundary;
  boundary.introducer = false;
  boundary.proximal = EndHold::kClamped;
  Environment environment;
  environment.damping = 200.0;
  const std::vector<double> position = {0.0,
                                        0.0025,
                                        0.005,
                                        0.0075,
                                        0.01,
                                        0.01 + 0.25 * wire.sections[1].length,
                                        0.01 + 0.5 * wire.sections[1].length,
                                        0.01 + 0.75 * wire.sections[1].length,
                                        wire.length()};
  StepperSettings settings;
  settings.max_iterations = 4;
  MixedStepper stepper(wire, discretise(wire, position), boundary, environment, settings);
  State state = stepper.initialState(0.0, 0.0);
  PhaseTimer timer;
  int hit_iteration_limit = 0;
  for (int k = 0; k < 400; ++k)
  {
    std::uint32_t pass = 0;
    const StepReport report = stepper.step(state, StepInput(), 1e-3, pass, nullptr, timer);
    ASSERT_TRUE(report.solved);
    ASSERT_LT(report.max_strain, 1e-3);
    hit_iteration_limit += report.hit_iteration_limit;
  }
  EXPECT_GT(hit_iteration_limit, 0);
  const Vector3d exact = boundary.origin + 0.01 * boundary.direction + 0.006 * boundary.director;
  EXPECT_LT((state.position.back() - exact).norm(), 2e-5);
}

}  // namespace
}  // namespace endovascular_sim::rod
