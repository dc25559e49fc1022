#include "contact/narrow_phase/smooth_foot.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/mesh_distance.h"
#include "test/contact/contact_fixtures.h"

namespace endovascular_sim::contact
{
namespace
{

/** A smooth wall with the search and, as reference, a fine tessellation. */
struct Fixture
{
  explicit Fixture(const geometry::TriangleMesh& mesh)
    : wall(mesh), bounds(wall), smooth(wall), search(smooth), fine(tessellate(smooth, 10)), reference(fine)
  {
  }

  /** The nearest foot of a point: that of the walks from all patches that may contain one. */
  SmoothFoot nearest(const Eigen::Vector3d& point) const
  {
    SmoothFoot best;
    best.height = 1.0;
    for (int t = 0; t < static_cast<int>(wall.triangles.size()); ++t)
      if (smooth.mayHaveFoot(t, bounds.triangle(t).heights(point), 3e-3))
      {
        const SmoothFoot foot = search.walk(point, t);
        if (std::abs(foot.height) < std::abs(best.height))
          best = foot;
      }
    return best;
  }

  Wall wall;
  WallBounds bounds;
  SmoothWall smooth;
  SmoothFootSearch search;
  geometry::TriangleMesh fine;
  geometry::MeshDistance reference;
};

/** Random points up to 1.2 mm in front of and 0.3 mm behind the wall. */
std::vector<Eigen::Vector3d> randomPoints(const Fixture& fixture, int count)
{
  std::mt19937 random(5);
  std::uniform_int_distribution<int> triangle(0, static_cast<int>(fixture.wall.triangles.size()) - 1);
  std::uniform_real_distribution<double> height(-0.3e-3, 1.2e-3);
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k < count; ++k)
  {
    const int t = triangle(random);
    const SmoothWall::Point on_wall = fixture.smooth.at(t, Eigen::Vector3d(0.2, 0.5, 0.3));
    points.emplace_back(on_wall.position + height(random) * on_wall.normal);
  }
  return points;
}

TEST(SmoothFoot, IsTheClosestPointOfTheSurface)
{
  // Relative heights of the bumps: the highest ones make creases of three quarters of the vertices.
  for (double bump : {0.0, 0.08, 0.25})
  {
    const Fixture fixture(bumpy(geometry::midpointSubdivision(bentTube(), 1), bump));
    double worst = 0.0;
    for (const Eigen::Vector3d& point : randomPoints(fixture, 300))
      worst = std::max(worst,
                       std::abs(std::abs(fixture.nearest(point).height) - fixture.reference.closest(point).distance));
    EXPECT_LT(worst, 5e-6) << bump;  // of the tessellation
  }
}

TEST(SmoothFoot, NormalIsTheGradientOfTheGap)
{
  constexpr double kStep = 1e-6;
  for (double bump : {0.0, 0.25})
  {
    const Fixture fixture(bumpy(bentTube(), bump));
    double worst = 0.0;
    for (const Eigen::Vector3d& point : randomPoints(fixture, 300))
    {
      const SmoothFoot foot = fixture.nearest(point);
      Eigen::Vector3d gradient;
      for (int axis = 0; axis < 3; ++axis)
      {
        const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
        gradient[axis] =
            (fixture.search.walk(point + step, foot).height - fixture.search.walk(point - step, foot).height) /
            (2.0 * kStep);
      }
      worst = std::max(worst, (gradient - foot.normal).norm());
      EXPECT_LT((point - foot.position - foot.height * foot.normal).norm(), 1e-8);
    }
    EXPECT_LT(worst, 1e-4) << bump;
  }
}

TEST(SmoothFoot, NormalIsContinuousAcrossFacets)
{
  const Fixture fixture(bentTube());
  constexpr double kRadius = 3e-3;  // m, of the path around the axis of a wall of 4 mm radius
  constexpr int kSteps = 3000;
  SmoothFoot before;
  for (int k = 0; k <= kSteps; ++k)
  {
    const double angle = 2.0 * M_PI * k / kSteps;
    const Eigen::Vector3d point(kRadius * std::cos(angle), kRadius * std::sin(angle),
                                0.01 + 2e-3 * std::sin(3.0 * angle));
    const SmoothFoot foot = fixture.nearest(point);
    if (k > 0)
    {
      EXPECT_LT((foot.normal - before.normal).norm(), 2.0 * 2.0 * M_PI / kSteps);
      EXPECT_LT(std::abs(foot.height - before.height), 1e-6);
    }
    before = foot;
  }
}

}  // namespace
}  // namespace endovascular_sim::contact
