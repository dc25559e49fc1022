#include <algorithm>

#include <gtest/gtest.h>

#include "contact/detector.h"
#include "test/contact/contact_fixtures.h"

namespace endovascular_sim::contact
{
namespace
{

constexpr double kTolerance = 1e-9;  // m: closer cases are not tested

/** Reference test: whether the interior of a reflex edge is a local minimum of the distance to a point within a cutoff.
 *  @param offset receives the vector from the edge to the point [m] */
bool isClosestEdge(const Wall& wall, const WallEdge& edge, const Eigen::Vector3d& point, double cutoff,
                   Eigen::Vector3d& offset)
{
  const Eigen::Vector3d& begin = wall.vertices[edge.vertices[0]];
  const Eigen::Vector3d along = wall.vertices[edge.vertices[1]] - begin;
  const double share = (point - begin).dot(along) / along.squaredNorm();
  offset = point - begin - share * along;
  return edge.reflex_angle > 0.0 && share > 1e-6 && share < 1.0 - 1e-6 && offset.norm() < cutoff - kTolerance &&
         offset.dot(edge.normal) > 0.0 && offset.dot(edge.into_triangle[0]) < -kTolerance &&
         offset.dot(edge.into_triangle[1]) < -kTolerance;
}

/** Reference test of a vertex, as isClosestEdge. */
bool isClosestVertex(const Wall& wall, int vertex, const Eigen::Vector3d& point, double cutoff, Eigen::Vector3d& offset)
{
  offset = point - wall.vertices[vertex];
  if (wall.vertex_reflex[vertex] == 0 || offset.norm() > cutoff - kTolerance ||
      offset.dot(wall.vertex_normals[vertex]) <= 0.0)
    return false;
  const auto behind = [&](int e)
  {
    const Eigen::Vector3d along = wall.vertices[wall.edges[e].otherEnd(vertex)] - wall.vertices[vertex];
    return offset.dot(along.normalized()) < -kTolerance;
  };
  return std::all_of(wall.vertex_edges[vertex].begin(), wall.vertex_edges[vertex].end(), behind);
}

/** Whether a set contains a feature of the wire's first node with the offset's direction and at most its gap. */
bool contains(const ContactSet& set, const Query& query, const Eigen::Vector3d& offset)
{
  const double gap = offset.norm() - query.radius[0];
  const auto is = [&](const Feature& f)
  {
    return f.edge == query.first_node && f.parameter == 0.0 && f.gap <= gap + 1e-12 &&
           f.normal.dot(offset.normalized()) > 0.9995 - 1e-9;
  };
  return std::any_of(set.features.begin(), set.features.end(), is);
}

class NodeFeatures : public testing::TestWithParam<double>
{
};

TEST_P(NodeFeatures, IncludeEveryEdgeAndVertexThatBruteForceFinds)
{
  Detector detector(bumpyTube(GetParam()), WallLaw{});
  const Wall& wall = detector.wall();
  std::mt19937 random(23);
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<std::size_t> any_vertex(0, wall.vertices.size() - 1);
  int edges = 0;
  int vertices = 0;
  const auto off = [&] { return Eigen::Vector3d(normal(random), normal(random), normal(random)); };
  Query query;
  query.margin = {0.5e-3, 0.5e-3};
  query.first_node = 3;
  query.radius = {0.4e-3, 0.4e-3};
  // Few random points lie in the cone of a vertex: every other trial searches for one.
  const auto any_point = [&](bool at_vertex)
  {
    Eigen::Vector3d point, offset;
    std::size_t v = 0;
    for (int attempt = 0; attempt < 200; ++attempt)
    {
      v = any_vertex(random);
      point = wall.vertices[v] + 0.4e-3 * (wall.vertex_normals[v] + std::min(0.5, GetParam()) * off());
      if (!at_vertex || isClosestVertex(wall, static_cast<int>(v), point, 1.0, offset))
        break;
    }
    return point;
  };
  for (int trial = 0; trial < 600; ++trial)
  {
    const Eigen::Vector3d first = any_point(trial % 2 == 0);
    query.nodes = {first, first + 1e-3 * off()};
    ContactSet set;
    detector.detect(query, set);
    const double cutoff = query.radius[0] + query.margin[0];
    Eigen::Vector3d offset;
    for (const WallEdge& edge : wall.edges)
      if (isClosestEdge(wall, edge, query.nodes[0], cutoff, offset))
      {
        ++edges;
        EXPECT_TRUE(contains(set, query, offset));
      }
    for (int vertex = 0; vertex < static_cast<int>(wall.vertices.size()); ++vertex)
      if (isClosestVertex(wall, vertex, query.nodes[0], cutoff, offset))
      {
        ++vertices;
        EXPECT_TRUE(contains(set, query, offset));
      }
  }
  EXPECT_GT(edges, 50);
  EXPECT_GT(vertices, 50);
}

// With the largest bumps the wall folds by more than a right angle at some edges.
INSTANTIATE_TEST_SUITE_P(Bumps, NodeFeatures, testing::Values(0.05, 0.1, 0.3, 0.8));

}  // namespace
}  // namespace endovascular_sim::contact
