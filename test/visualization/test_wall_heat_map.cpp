#include "visualization/wall_heat_map.h"

#include <gtest/gtest.h>

namespace endovascular_sim::visualization
{
namespace
{

/** Square plate of 20 mm in the plane z = height, with vertices at a spacing of 0.5 mm. */
void addPlate(geometry::TriangleMesh& mesh, double height, bool facing_up)
{
  constexpr int kVertices = 41;
  const int first = static_cast<int>(mesh.vertices.size());
  for (int i = 0; i < kVertices; ++i)
    for (int j = 0; j < kVertices; ++j)
      mesh.vertices.emplace_back(0.5e-3 * i, 0.5e-3 * j, height);
  for (int i = 0; i + 1 < kVertices; ++i)
    for (int j = 0; j + 1 < kVertices; ++j)
    {
      const int a = first + i * kVertices + j;
      const int b = a + kVertices;
      mesh.triangles.emplace_back(facing_up ? Eigen::Vector3i(a, b, b + 1) : Eigen::Vector3i(a, b + 1, b));
      mesh.triangles.emplace_back(facing_up ? Eigen::Vector3i(a, b + 1, a + 1) : Eigen::Vector3i(a, a + 1, b + 1));
    }
}

constexpr std::uint32_t kMiddle = 2 * (20 * 40 + 20);  // triangle at the centre of the first plate

TEST(WallHeatMap, DecaysOverTheRadiusAndLiesInsideTheLumen)
{
  geometry::TriangleMesh mesh;
  addPlate(mesh, 0.0, true);
  const Eigen::Vector3i corners = mesh.triangles[kMiddle];
  const Eigen::Vector3d centre =
      (mesh.vertices[corners[0]] + mesh.vertices[corners[1]] + mesh.vertices[corners[2]]) / 3.0;
  const HeatPatch patch = WallHeatMap(mesh, 2e-3, 0.1e-3).patch({kMiddle}, {0.5F});
  ASSERT_FALSE(patch.corners.empty());
  ASSERT_EQ(patch.corners.size() % 3, 0U);
  ASSERT_EQ(patch.corners.size(), patch.values.size());
  double hottest = 0.0;
  for (std::size_t k = 0; k < patch.corners.size(); ++k)
  {
    EXPECT_NEAR(patch.corners[k].z(), -0.1e-3, 1e-12);  // the normals point up, out of the lumen
    const double distance = (patch.corners[k].head<2>() - centre.head<2>()).norm();
    EXPECT_LT(distance, 2e-3 + 0.75e-3);
    if (distance > 2e-3)
    {
      EXPECT_EQ(patch.values[k], 0.0);
    }
    hottest = std::max(hottest, patch.values[k]);
  }
  EXPECT_NEAR(hottest, 0.5, 1e-7);
}

TEST(WallHeatMap, UsesTheMaximumOfOverlappingPatches)
{
  geometry::TriangleMesh mesh;
  addPlate(mesh, 0.0, true);
  const WallHeatMap heat(mesh, 2e-3, 0.0);
  const HeatPatch low = heat.patch({kMiddle}, {0.1F});
  const HeatPatch both = heat.patch({kMiddle, kMiddle}, {0.1F, 0.3F});
  ASSERT_EQ(low.values.size(), both.values.size());
  for (std::size_t k = 0; k < low.values.size(); ++k)
    EXPECT_NEAR(both.values[k], 3.0 * low.values[k], 1e-7);
}

TEST(WallHeatMap, DoesNotAffectTheOppositeWall)
{
  geometry::TriangleMesh mesh;
  addPlate(mesh, 0.0, true);
  addPlate(mesh, -1e-3, false);  // the opposite wall of a lumen 1 mm wide
  for (const Eigen::Vector3d& corner : WallHeatMap(mesh, 2e-3, 0.0).patch({kMiddle}, {0.5F}).corners)
    EXPECT_EQ(corner.z(), 0.0);
}

TEST(WallHeatMap, IncludesATriangleLargerThanTheRadius)
{
  geometry::TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}};
  mesh.triangles = {{0, 1, 2}};
  const HeatPatch patch = WallHeatMap(mesh, 2e-3, 0.0).patch({0}, {0.5F});
  ASSERT_EQ(patch.values.size(), 3U);
  for (const double value : patch.values)
    EXPECT_EQ(value, 0.5);
}

TEST(WallHeatMap, IgnoresInvalidTriangles)
{
  geometry::TriangleMesh mesh;
  addPlate(mesh, 0.0, true);
  const WallHeatMap heat(mesh, 2e-3, 0.0);
  EXPECT_TRUE(heat.patch({4000000000U}, {0.5F}).corners.empty());
  EXPECT_TRUE(heat.patch({kMiddle}, {}).corners.empty());
}

}  // namespace
}  // namespace endovascular_sim::visualization
