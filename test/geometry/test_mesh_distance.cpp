#include "geometry/mesh_distance.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "geometry/closest_point_on_triangle.h"
#include "test/vessel/io/mesh_files.h"

namespace endovascular_sim::geometry
{
namespace
{

/** Closed tube of radius 4 mm and length 40 mm, in metres. */
TriangleMesh tube(int around, int along)
{
  TriangleMesh mesh = vessel::capsule(around, along);
  for (Eigen::Vector3d& vertex : mesh.vertices)
    vertex *= 1e-3;
  return mesh;
}

double distanceByBruteForce(const TriangleMesh& mesh, const Eigen::Vector3d& p)
{
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3i& t : mesh.triangles)
    least = std::min(
        least, (closestPointOnTriangle(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]).point - p)
                   .squaredNorm());
  return std::sqrt(least);
}

/** Points on the axis, near it, anywhere in a box around the tube, and on the wall. */
std::vector<Eigen::Vector3d> queries(const TriangleMesh& mesh)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k < 100; ++k)
  {
    const double z = 20e-3 + 20e-3 * uniform(random);
    points.emplace_back(0.0, 0.0, z);
    points.emplace_back(1e-5 * uniform(random), 1e-5 * uniform(random), z);
    points.emplace_back(8e-3 * uniform(random), 8e-3 * uniform(random), 20e-3 + 30e-3 * uniform(random));
    points.push_back(mesh.vertices[random() % mesh.vertices.size()]);
  }
  return points;
}

TEST(MeshDistance, EqualsTheSearchOfAllTriangles)
{
  for (const int around : {5, 96})
  {
    const TriangleMesh mesh = tube(around, 60);
    const MeshDistance distance(mesh);
    for (const Eigen::Vector3d& p : queries(mesh))
    {
      const ClosestPoint closest = distance.closest(p);
      EXPECT_EQ(closest.distance, distanceByBruteForce(mesh, p));
      EXPECT_EQ(closest.distance, (closest.point - p).norm());
      ASSERT_GE(closest.triangle, 0);
    }
  }
}

TEST(MeshDistance, IsNearerThanALimitAboveTheDistanceOnly)
{
  const TriangleMesh mesh = tube(96, 60);
  const MeshDistance distance(mesh);
  for (const Eigen::Vector3d& p : queries(mesh))
  {
    const double least = distance.closest(p).distance;
    EXPECT_FALSE(distance.isNearer(p, least));
    EXPECT_TRUE(distance.isNearer(p, std::nextafter(least, 1.0)));
    EXPECT_EQ(distance.closest(p, 0.5 * least).triangle, -1);
  }
}

TEST(MeshDistance, OfAnEmptyMeshHasNoTriangle)
{
  const TriangleMesh mesh;
  EXPECT_EQ(MeshDistance(mesh).closest(Eigen::Vector3d::Zero()).triangle, -1);
  EXPECT_FALSE(MeshDistance(mesh).isNearer(Eigen::Vector3d::Zero(), 1.0));
}

}  // namespace
}  // namespace endovascular_sim::geometry
