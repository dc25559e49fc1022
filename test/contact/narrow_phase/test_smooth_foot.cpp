#include "contact/narrow_phase/smooth_foot.h"

#include <cmath>
#include <random>
#include <utility>
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
    : wall(mesh),
      bounds(wall),
      facets(wall, bounds),
      smooth(wall),
      search(smooth),
      fine(tessellate(smooth, 10)),
      reference(fine)
  {
  }

  /** The nearest foot of a point: that of the walks from all triangles near it. */
  SmoothFoot nearest(const Eigen::Vector3d& point) const
  {
    SmoothFoot best;
    best.height = 1.0;
    NarrowPhase::Minimum minimum;
    for (int t = 0; t < static_cast<int>(wall.triangles.size()); ++t)
      if (facets.faceFeature(point, t, 3e-3, minimum))
      {
        const SmoothFoot foot = search.walk(point, minimum.feature.triangle, minimum.feature.point);
        if (std::abs(foot.height) < std::abs(best.height))
          best = foot;
      }
    return best;
  }

  bool isNearCrease(const SmoothFoot& foot) const
  {
    for (int vertex : wall.triangles[foot.triangle])
      for (int e : wall.vertex_edges[vertex])
        if (smooth.isCrease(wall.edges[e].vertices[0]) || smooth.isCrease(wall.edges[e].vertices[1]))
          return true;
    return false;
  }

  Wall wall;
  WallBounds bounds;
  NarrowPhase facets;
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
  // Relative height of the bumps, and bound of the excess over the distance to the tessellation [m]. The normal omits
  // the derivative of the weights: on a rough wall it deviates from that of the surface.
  const std::vector<std::pair<double, double>> walls = {{0.0, 20e-6}, {0.08, 30e-6}};
  for (const auto& [bump, bound] : walls)
  {
    const Fixture fixture(bumpy(geometry::midpointSubdivision(bentTube(), 1), bump));
    for (const Eigen::Vector3d& point : randomPoints(fixture, 150))
    {
      const SmoothFoot foot = fixture.nearest(point);
      EXPECT_NEAR(std::abs(foot.height), fixture.reference.closest(point).distance, bound);
    }
  }
}

TEST(SmoothFoot, GapAndNormalAgreeWithFiniteDifferences)
{
  const Fixture fixture(bentTube());
  constexpr double kStep = 1e-6;
  int checked = 0;
  for (const Eigen::Vector3d& point : randomPoints(fixture, 300))
  {
    const SmoothFoot foot = fixture.nearest(point);
    if (fixture.isNearCrease(foot))
      continue;
    ++checked;
    Eigen::Vector3d gradient;
    for (int axis = 0; axis < 3; ++axis)
    {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
      gradient[axis] =
          (fixture.search.walk(point + step, foot).height - fixture.search.walk(point - step, foot).height) /
          (2.0 * kStep);
    }
    EXPECT_LT((gradient - foot.normal).norm(), 0.1);  // 12 facets of 5 mm around a bend: the quadrics disagree by 4 %
    EXPECT_LT((point - foot.position - foot.height * foot.normal).norm(), 1e-8);
  }
  EXPECT_GT(checked, 80);
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
