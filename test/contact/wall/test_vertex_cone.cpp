#include <cmath>

#include <gtest/gtest.h>

#include "contact/wall/wall.h"
#include "test/contact/contact_fixtures.h"

namespace endovascular_sim::contact
{
namespace
{

/** Whether a vertex is a local minimum of the distance to a point in some direction from it. */
bool isMinimum(const Wall& wall, int vertex, const Eigen::Vector3d& direction)
{
  for (int e : wall.vertex_edges[vertex])
  {
    const Eigen::Vector3d along = wall.vertices[wall.edges[e].otherEnd(vertex)] - wall.vertices[vertex];
    if (direction.dot(along) > 0.0)
      return false;
  }
  return true;
}

/** Whether a direction points to the lumen side of a triangle at a vertex. */
bool isInFront(const Wall& wall, int vertex, const Eigen::Vector3d& direction)
{
  for (int e : wall.vertex_edges[vertex])
    for (int t : wall.edges[e].triangles)
      if (direction.dot(wall.normals[t]) >= 0.0)
        return true;
  return false;
}

class VertexCone : public testing::TestWithParam<double>
{
};

TEST_P(VertexCone, ContainsEveryDirectionInWhichTheVertexIsAMinimum)
{
  const Wall wall(bumpyTube(GetParam()));
  std::mt19937 random(5);
  std::normal_distribution<double> any;
  int minima = 0;
  int bounded = 0;
  double fullest = 0.0;
  for (int v = 0; v < static_cast<int>(wall.vertices.size()); ++v)
  {
    bounded += wall.vertex_cone[v] < M_PI_2;
    for (int trial = 0; trial < 300; ++trial)
    {
      const Eigen::Vector3d off(any(random), any(random), any(random));
      const Eigen::Vector3d direction = (wall.vertex_normals[v] + 2.0 * GetParam() * off).normalized();
      if (wall.vertex_cone[v] >= M_PI_2 || !isMinimum(wall, v, direction) || !isInFront(wall, v, direction))
        continue;
      ++minima;
      const double angle = angleBetween(direction, wall.vertex_normals[v]);
      EXPECT_LE(angle, wall.vertex_cone[v] + 1e-9);
      if (wall.vertex_cone[v] > 0.01)
        fullest = std::max(fullest, angle / wall.vertex_cone[v]);
    }
  }
  EXPECT_GT(minima, 100);
  EXPECT_GT(bounded, 100);
  EXPECT_GT(fullest, 0.5);  // the bound is tight enough to be useful
}

INSTANTIATE_TEST_SUITE_P(Bumps, VertexCone, testing::Values(0.02, 0.1, 0.3));

}  // namespace
}  // namespace endovascular_sim::contact
