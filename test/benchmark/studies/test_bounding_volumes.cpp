#include "benchmark/studies/bounding_volumes.h"

#include <gtest/gtest.h>

#include "benchmark/studies/contact_study.h"
#include "geometry/closest_point_on_triangle.h"
#include "geometry/mesh_distance.h"
#include "vessel/anatomy/tube.h"

namespace endovascular_sim::benchmark
{
namespace
{

geometry::TriangleMesh channel()
{
  vessel::TubeShape shape;
  shape.radius = 4e-3;
  shape.facet_length = 2e-3;
  shape.facets_around = 16;
  shape.pieces = {{0.03, 0.0, 0.0}, {0.03, 25.0, 0.3}};
  return vessel::tubeMesh(shape);
}

TEST(BoundingVolumes, AllKindsFindTheNearestTriangleAndAllTrianglesWithinTheRadius)
{
  const geometry::TriangleMesh mesh = channel();
  const std::vector<Eigen::Vector3d> points =
      curveAlongWall(mesh, Eigen::Vector3d::Zero(), {0.3, 0.2, 1.0}, 0.45e-3, 1e-3, 60);
  double distance = 0.0;
  double within = 0.0;
  for (const Eigen::Vector3d& p : points)
  {
    double nearest = 1.0;
    for (const Eigen::Vector3i& c : mesh.triangles)
    {
      const double d =
          (geometry::closestPointOnTriangle(p, mesh.vertices[c[0]], mesh.vertices[c[1]], mesh.vertices[c[2]]).point - p)
              .norm();
      nearest = std::min(nearest, d);
      within += d <= 2e-3;
    }
    distance += nearest;
  }
  const auto count = static_cast<double>(points.size());
  for (const VolumeResult& result : compareBoundingVolumes(mesh, points, 2e-3, 2))
  {
    EXPECT_NEAR(result.mean_distance, distance / count, 1e-12) << result.name;
    EXPECT_GE(result.collect_leaves, within / count) << result.name;
    EXPECT_LE(result.collect_leaves, 4.0 * within / count) << result.name;
    EXPECT_LT(result.nearest_leaves, 12.0) << result.name;
  }
}

TEST(CurveAlongWall, HasAConstantDistance)
{
  const geometry::TriangleMesh mesh = channel();
  const geometry::MeshDistance wall(mesh);
  for (const Eigen::Vector3d& p : curveAlongWall(mesh, Eigen::Vector3d::Zero(), {0.0, 0.1, 1.0}, 0.45e-3, 0.5e-3, 80))
    EXPECT_NEAR(wall.closest(p).distance, 0.45e-3, 0.05e-3);
}

}  // namespace
}  // namespace endovascular_sim::benchmark
