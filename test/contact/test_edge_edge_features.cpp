#include <algorithm>

#include <gtest/gtest.h>

#include "contact/detector.h"
#include "geometry/closest_points_on_segments.h"
#include "test/contact/contact_fixtures.h"

namespace endovascular_sim::contact
{
namespace
{

/** Reference test: whether the interior of a reflex edge is a local minimum of the distance to the surface of the
 *  wire's edge, off the edge's ends and within the margin. */
bool isMinimum(const Wall& wall, const WallEdge& reflex_edge, const Query& query)
{
  const Eigen::Vector3d& a = query.nodes[0];
  const Eigen::Vector3d& b = query.nodes[1];
  const Eigen::Vector3d& begin = wall.vertices[reflex_edge.vertices[0]];
  const Eigen::Vector3d& end = wall.vertices[reflex_edge.vertices[1]];
  const geometry::SegmentPair pair =
      geometry::closestPointsOfCone({a, b, query.radius[1] - query.radius[0]}, begin, end);
  if (pair.first < 0.01 || pair.first > 0.99 || pair.second < 1e-6 || pair.second > 1.0 - 1e-6)
    return false;
  const Eigen::Vector3d offset = a + pair.first * (b - a) - begin - pair.second * (end - begin);
  const double slack = 0.9e-3 * offset.norm();
  const auto limit = [&query](std::size_t node) { return query.radius[node] + query.margin[node] - 1e-9; };
  return offset.norm() < (1.0 - pair.first) * limit(0) + pair.first * limit(1) &&
         offset.dot(wall.normals[reflex_edge.triangles[0]]) > 0.0 &&
         offset.dot(wall.normals[reflex_edge.triangles[1]]) > 0.0 && offset.dot(reflex_edge.into_triangle[0]) < slack &&
         offset.dot(reflex_edge.into_triangle[1]) < slack;
}

class EdgeEdgeFeatures : public testing::TestWithParam<double>
{
};

TEST_P(EdgeEdgeFeatures, AreThoseThatBruteForceFinds)
{
  const geometry::TriangleMesh mesh = bumpyTube(GetParam());
  Detector detector(mesh, WallLaw{});
  const Wall& wall = detector.wall();
  std::mt19937 random(17);
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<std::size_t> any_edge(0, wall.edges.size() - 1);
  int features = 0;
  for (int trial = 0; trial < 600; ++trial)
  {
    const WallEdge& reflex_edge = wall.edges[any_edge(random)];
    const Eigen::Vector3d middle =
        0.5 * (wall.vertices[reflex_edge.vertices[0]] + wall.vertices[reflex_edge.vertices[1]]);
    const Eigen::Vector3d along = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    const Eigen::Vector3d level = (along - 0.9 * reflex_edge.normal.dot(along) * reflex_edge.normal).normalized();
    Query query;
    query.margin = {0.5e-3, trial % 2 == 0 ? 0.5e-3 : 0.16e-3};
    query.first_node = 3;
    query.radius = {0.4e-3, trial % 2 == 0 ? 0.4e-3 : 1.2e-3};
    for (double share : {-0.7, 1.1})
      query.nodes.emplace_back(middle + 0.4e-3 * reflex_edge.normal + share * 1e-3 * level);
    ContactSet set;
    detector.detect(query, set);
    for (std::size_t e = 0; e < wall.edges.size(); ++e)
    {
      if (wall.edges[e].reflex_angle < 2e-4 || !isMinimum(wall, wall.edges[e], query))
        continue;
      ++features;
      const auto is = [&](const Feature& f)
      { return f.edge == query.first_node && f.id == 3 * static_cast<std::int64_t>(e) + 1; };
      EXPECT_TRUE(std::any_of(set.features.begin(), set.features.end(), is));
    }
  }
  EXPECT_GT(features, 50);
}

INSTANTIATE_TEST_SUITE_P(Bumps, EdgeEdgeFeatures, testing::Values(0.02, 0.1, 0.3));

}  // namespace
}  // namespace endovascular_sim::contact
