#include "benchmark/reference/mixed_statics.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::benchmark
{
namespace
{

using Eigen::Vector3d;

/** Rod of length 1 and EI = 1, clamped at the origin along x. */
rod::MixedRod unitRod(int edges, rod::EndHold distal = rod::EndHold::kFree)
{
  rod::MixedEdge edge;
  edge.length = 1.0 / edges;
  edge.flexibility = 1.0;
  return rod::MixedRod(std::vector<rod::MixedEdge>(static_cast<std::size_t>(edges), edge),
                       {rod::EndHold::kClamped, Vector3d::UnitX()}, {distal, Vector3d::UnitX()});
}

rod::State equilibrium(rod::MixedRod& rod, const std::vector<rod::NodalForce>& forces, int load_steps = 1)
{
  rod::State state = rod.straight(Vector3d::Zero(), Vector3d::UnitX());
  StaticsSettings settings;
  settings.load_steps = load_steps;
  const StaticsReport report = solveStatics(rod, forces, settings, state);
  EXPECT_TRUE(report.converged);
  EXPECT_LT(report.residual, 1e-9);
  return state;
}

double order(double coarse, double fine)
{
  return std::log2(coarse / fine);
}

// Cantilever elastica, tip x/L and y/L by an independent boundary value solver.
TEST(MixedStatics, TipOfTheElasticaConvergesWithFourthOrder)
{
  const Vector3d light(0.9435667637166234, -0.3017207737998133, 0.0);
  const Vector3d heavy(0.61237163927557, -0.7137915236119128, 0.0);
  for (const auto& [load, exact] : {std::make_pair(1.0, light), std::make_pair(5.0, heavy)})
  {
    std::vector<double> error;
    for (const int edges : {8, 16, 32})
    {
      rod::MixedRod rod = unitRod(edges);
      error.push_back((equilibrium(rod, {{edges, Vector3d(0.0, -load, 0.0)}}).position.back() - exact).norm());
    }
    EXPECT_NEAR(order(error[0], error[1]), 4.0, 0.2);
    EXPECT_NEAR(order(error[1], error[2]), 4.0, 0.2);
    rod::MixedRod rod = unitRod(24);
    EXPECT_LT((equilibrium(rod, {{24, Vector3d(0.0, -load, 0.0)}}).position.back() - exact).norm(), 1e-6);
  }
}

TEST(MixedStatics, SpatialForcesConvergeWithFourthOrder)
{
  const auto tip = [](int edges)
  {
    rod::MixedRod rod = unitRod(edges);
    return equilibrium(rod, {{edges / 2, Vector3d(0.0, 4.0, -3.0)}, {edges, Vector3d(-1.0, 1.5, 3.0)}}).position.back();
  };
  const Vector3d fine = tip(128);
  const double coarse_error = (tip(8) - fine).norm();
  const double middle_error = (tip(16) - fine).norm();
  EXPECT_NEAR(order(coarse_error, middle_error), 4.0, 0.2);
  EXPECT_NEAR(order(middle_error, (tip(32) - fine).norm()), 4.0, 0.2);
  EXPECT_LT(middle_error, 3e-6);
}

// Planar quarter-circle cantilever with a dead tip load, PL²/EI = 1.
TEST(MixedStatics, PreCurvedRodConvergesWithFourthOrder)
{
  const Vector3d exact(0.804105101290247, 0.4818706970436423, 0.0);
  std::vector<double> error;
  for (const int edges : {8, 16, 32})
  {
    rod::MixedRod rod = unitRod(edges);
    for (int j = 0; j < edges; ++j)
      rod.edge(j).rest_curvature = {Vector3d(0.0, 0.0, M_PI_2), Vector3d(0.0, 0.0, M_PI_2)};
    error.push_back((equilibrium(rod, {{edges, Vector3d(0.0, -1.0, 0.0)}}).position.back() - exact).norm());
  }
  EXPECT_LT(error[0], 3e-6);
  EXPECT_NEAR(order(error[0], error[1]), 4.0, 0.2);
  EXPECT_NEAR(order(error[1], error[2]), 4.0, 0.2);
}

// Stiffness jump of 4 : 1 at the centre: a straight wire with a spatial load, and a curved tip with a planar load.
TEST(MixedStatics, SectionJumpAtANodePreservesFourthOrder)
{
  for (const double curvature : {0.0, 1.0})
  {
    const auto tip = [curvature](int edges)
    {
      rod::MixedRod rod = unitRod(edges);
      for (int j = 0; j < edges; ++j)
        rod.edge(j).flexibility = j < edges / 2 ? 0.25 : 1.0;
      for (int j = edges / 2; j < edges; ++j)
        rod.edge(j).rest_curvature = {Vector3d(0.0, 0.0, curvature), Vector3d(0.0, 0.0, curvature)};
      const Vector3d force(0.0, -5.0, curvature > 0.0 ? 0.0 : 2.0);
      return equilibrium(rod, {{edges, force}, {edges / 2, 2.0 * force}}).position.back();
    };
    const Vector3d fine = tip(200);
    const double coarse_error = (tip(12) - fine).norm();
    const double middle_error = (tip(24) - fine).norm();
    EXPECT_NEAR(order(coarse_error, middle_error), 4.0, 0.2);
    EXPECT_NEAR(order(middle_error, (tip(48) - fine).norm()), 4.0, 0.2);
  }
}

TEST(MixedStatics, UnequalEdgesPreserveFourthOrder)
{
  const Vector3d exact(0.61237163927557, -0.7137915236119128, 0.0);
  std::vector<double> error;
  for (const int edges : {12, 24, 48})
  {
    rod::MixedRod rod = unitRod(edges);
    const auto coordinate = [edges](int node)
    { return (node + 0.08 * edges * std::sin(5.0 * node / edges) / 1.0) / edges; };
    const double end = coordinate(edges);
    for (int j = 0; j < edges; ++j)
      rod.edge(j).length = (coordinate(j + 1) - coordinate(j)) / end;
    error.push_back((equilibrium(rod, {{edges, Vector3d(0.0, -5.0, 0.0)}}).position.back() - exact).norm());
  }
  EXPECT_NEAR(order(error[0], error[1]), 4.0, 0.3);
  EXPECT_NEAR(order(error[1], error[2]), 4.0, 0.2);
}

// Heavy elastica, wL³/EI = 10, and the heavy cantilever of the published comparison, wL³/EI = 8.75.
TEST(MixedStatics, HeavyCantileverConvergesWithFourthOrderToBelow1e6At25Nodes)
{
  const Vector3d exact(0.6975592593323616, -0.6655170278745548, 0.0);
  const auto tip = [](int edges, double weight)
  {
    rod::MixedRod rod = unitRod(edges);
    for (int j = 0; j < edges; ++j)
      rod.edge(j).load = Vector3d(0.0, -weight, 0.0);
    const rod::State state = equilibrium(rod, {});
    if (weight == 10.0)
    {
      EXPECT_NEAR(rod.bendingEnergy(state), 1.1126082625962972, 1e-5);
    }
    return state.position.back();
  };
  const double coarse_error = (tip(8, 8.75) - exact).norm();
  const double middle_error = (tip(16, 8.75) - exact).norm();
  EXPECT_NEAR(order(coarse_error, middle_error), 4.0, 0.2);
  EXPECT_NEAR(order(middle_error, (tip(32, 8.75) - exact).norm()), 4.0, 0.2);
  EXPECT_LT((tip(24, 8.75) - exact).norm(), 1e-6);
  EXPECT_LT((tip(24, 10.0) - Vector3d(0.6563537612385988, -0.7001997155143129, 0.0)).norm(), 1e-6);
}

// Post-buckling elastica, clamped ends, end shortening 0.1.
TEST(MixedStatics, PostBucklingOfAClampedRodEqualsTheElastica)
{
  const double load = 41.57025579315579;
  const double deflection = 0.19492431112557375;
  std::vector<double> load_error;
  for (const int edges : {16, 64})
  {
    rod::MixedRod rod = unitRod(edges, rod::EndHold::kClamped);
    rod::State state = rod.straight(Vector3d::Zero(), Vector3d::UnitX());
    for (int i = 0; i <= edges; ++i)
    {
      const double s = static_cast<double>(i) / edges;
      state.position[i] = Vector3d(0.9 * s, 0.1 * (1.0 - std::cos(2.0 * M_PI * s)), 0.0);
    }
    ASSERT_TRUE(solveStatics(rod, {}, StaticsSettings(), state).converged);
    // The ends carry no transverse force; the axial force is the tension of the chord at the inflection point.
    Vector3d force = Vector3d::Zero();
    rod::MixedRod::Matrix unused;
    unused.reset(rod.size(state));
    std::vector<double> gradient(static_cast<std::size_t>(rod.size(state)), 0.0);
    rod.assemble(state, gradient, unused);
    for (int axis = 0; axis < 3; ++axis)
      force[axis] = gradient[rod.positionRow(state, 0) + axis];
    EXPECT_NEAR(force.y(), 0.0, 1e-7);
    load_error.push_back(std::abs(force.x() - load));
    EXPECT_NEAR(std::abs(state.position[edges / 2].y()), deflection, 1e-6);
  }
  EXPECT_NEAR(0.5 * order(load_error[0], load_error[1]), 4.0, 0.2);
  EXPECT_LT(load_error[0], 2e-6 * load);
}

// Pinned ends halve the wave number of the elastica: P L²/EI = 10.39 at end shortening 0.1.
TEST(MixedStatics, PostBucklingOfAPinnedRodEqualsTheElastica)
{
  const int edges = 32;
  rod::MixedEdge edge;
  edge.length = 1.0 / edges;
  edge.flexibility = 1.0;
  rod::MixedRod rod(std::vector<rod::MixedEdge>(edges, edge), {rod::EndHold::kPinned, Vector3d::UnitX()},
                    {rod::EndHold::kPinned, Vector3d::UnitX()});
  rod::State state = rod.straight(Vector3d::Zero(), Vector3d::UnitX());
  for (int i = 0; i <= edges; ++i)
    state.position[i] = Vector3d(0.9 * i / edges, 0.2 * std::sin(M_PI * i / edges), 0.0);
  ASSERT_TRUE(solveStatics(rod, {}, StaticsSettings(), state).converged);
  rod::MixedRod::Matrix unused;
  unused.reset(rod.size(state));
  std::vector<double> gradient(static_cast<std::size_t>(rod.size(state)), 0.0);
  rod.assemble(state, gradient, unused);
  EXPECT_NEAR(gradient[0], 10.392563948288947, 2e-5);
  EXPECT_NEAR(rod.bendingEnergy(state), 1.0126022229086291, 1e-5);
}

TEST(MixedStatics, ReportsMissingConvergence)
{
  rod::MixedRod rod = unitRod(8);
  rod::State state = rod.straight(Vector3d::Zero(), Vector3d::UnitX());
  StaticsSettings settings;
  settings.max_iterations = 2;
  EXPECT_FALSE(solveStatics(rod, {{8, Vector3d(0.0, -20.0, 0.0)}}, settings, state).converged);
}

}  // namespace
}  // namespace endovascular_sim::benchmark
