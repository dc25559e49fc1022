#include "instrument/rest_shape.h"

#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/Geometry>

#include "benchmark/reference/equilibrium.h"
#include "instrument/tip_shape.h"

namespace endovascular_sim::instrument
{
namespace
{

rod::Section sectionOf(double length, const Eigen::Vector2d& rest_curvature)
{
  rod::Section section;
  section.length = length;
  section.bending_stiffness = 100e-6;
  section.torsional_stiffness = 80e-6;
  section.axial_stiffness = 1e4;
  section.radius = 5e-4;
  section.density = 1200.0;
  section.rest_curvature = rest_curvature;
  return section;
}

Eigen::Vector2d straight()
{
  return Eigen::Vector2d::Zero();
}

/** Curves of a JL4 catheter with a part of its shaft. */
rod::Wire hook()
{
  return {{sectionOf(0.05, straight()), sectionOf(0.015 * M_PI, arcCurvature(0.015, 0.0)), sectionOf(0.04, straight()),
           sectionOf(0.003 * M_PI, arcCurvature(0.006, 0.0)), sectionOf(0.008, straight())}};
}

TEST(RestShape, IsALineAlongZForAStraightWire)
{
  const auto points = restShape({{sectionOf(0.1, straight()), sectionOf(0.05, straight())}}, 0.01);
  ASSERT_EQ(points.size(), 16U);
  for (const RestPoint& point : points)
    EXPECT_LT((point.position - point.arc_length * Eigen::Vector3d::UnitZ()).norm(), 1e-15);
}

TEST(RestShape, BendsAboutD1AtDirectionZero)
{
  // A rotation by 90° about x maps z to −y.
  const auto points = restShape({{sectionOf(0.01 * M_PI, arcCurvature(0.02, 0.0))}}, 1e-3);
  EXPECT_LT((points.back().position - Eigen::Vector3d(0.0, -0.02, 0.02)).norm(), 1e-15);
  EXPECT_LT((points.back().tangent - Eigen::Vector3d(0.0, -1.0, 0.0)).norm(), 1e-15);
  EXPECT_LT((points.back().d1 - Eigen::Vector3d::UnitX()).norm(), 1e-15);
}

TEST(RestShape, IsIndependentOfTheSpacing)
{
  rod::Wire wire = hook();
  wire.sections[3].rest_curvature = arcCurvature(0.006, 0.9);
  const RestPoint coarse = restShape(wire, 1.0).back();
  const RestPoint fine = restShape(wire, 1e-4).back();
  EXPECT_LT((coarse.position - fine.position).norm(), 1e-13);
  EXPECT_LT((coarse.d1 - fine.d1).norm(), 1e-12);
}

TEST(RestShape, LeavesThePlaneIfTheDirectionChanges)
{
  // A rotation by 90° about d1 = x gives the tangent −y and d2 = z. A rotation by 90° about d2 then maps −y to +x.
  const auto points = restShape(
      {{sectionOf(0.01 * M_PI, arcCurvature(0.02, 0.0)), sectionOf(0.01 * M_PI, arcCurvature(0.02, M_PI / 2.0))}},
      1e-3);
  const RestPoint& corner = points[points.size() / 2];
  const Eigen::Vector3d d2 = corner.tangent.cross(corner.d1);
  const Eigen::Vector3d tangent = d2.cross(corner.tangent);
  EXPECT_LT((points.back().tangent - tangent).norm(), 1e-12);
  EXPECT_NEAR(std::abs(points.back().tangent.x()), 1.0, 1e-12);
}

TEST(RestShape, IsTheEquilibriumOfAnUnloadedRod)
{
  // The rod is clamped at its proximal end and otherwise unloaded. The solver starts from the straight wire, with a
  // stepwise increase of the curvature. The clamp of the discrete rod acts at the midpoint of its first edge.
  const rod::Wire wire = hook();
  constexpr int kNodes = 400;
  benchmark::EquilibriumProblem problem;
  problem.rod = rod::discretiseUniformly(wire, kNodes);
  problem.held.assign(kNodes, false);
  problem.held[0] = problem.held[1] = true;
  benchmark::Equilibrium shape;
  for (const double s : problem.rod.position)
    shape.position.push_back(s * Eigen::Vector3d::UnitZ());
  for (int step = 1; step <= 20; ++step)
  {
    // All arcs are coplanar, so the binormal d1 is constant in space.
    problem.rest_binormal.clear();
    for (const Eigen::Vector2d& curvature : problem.rod.rest_curvature)
      problem.rest_binormal.push_back(-curvature[1] * step / 20.0 * Eigen::Vector3d::UnitX());
    ASSERT_TRUE(benchmark::EquilibriumSolver(problem).solve(shape)) << step;
  }
  const auto drawn = restShape(wire, 1e-5);
  double distance = 0.0;
  for (int i = 0; i < kNodes; ++i)
  {
    double nearest = 1.0;
    for (const RestPoint& point : drawn)
      if (std::abs(point.arc_length - problem.rod.position[i]) < 2e-5)
        nearest = std::min(nearest, (point.position - shape.position[i]).norm());
    distance = std::max(distance, nearest);
  }
  // The error is of second order in the edge length of 0.38 mm.
  EXPECT_LT(distance, 5e-5);
}

}  // namespace
}  // namespace endovascular_sim::instrument
