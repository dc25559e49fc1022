#include "rviz_plugin/model/vessel_drawing.h"

#include <limits>

#include <gtest/gtest.h>

namespace endovascular_sim::rviz_plugin
{
namespace
{

VesselMesh tetrahedron()
{
  VesselMesh message;
  message.version = 1;
  message.content_hash = 42;
  const double corners[4][3] = {{0, 0, 0}, {1e-2, 0, 0}, {0, 1e-2, 0}, {0, 0, 1e-2}};
  for (const auto& corner : corners)
  {
    geometry_msgs::Point point;
    point.x = corner[0];
    point.y = corner[1];
    point.z = corner[2];
    message.mesh.vertices.push_back(point);
  }
  const unsigned faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  for (const auto& face : faces)
  {
    shape_msgs::MeshTriangle triangle;
    for (std::size_t k = 0; k < 3; ++k)
      triangle.vertex_indices[k] = face[k];
    message.mesh.triangles.push_back(triangle);
  }
  return message;
}

ContactForceMap forceOnTriangle(std::uint32_t triangle, float peak)
{
  ContactForceMap map;
  map.content_hash = 42;
  map.time = 1.0;
  map.triangles = {triangle};
  map.peak = {peak};
  return map;
}

TEST(VesselDrawing, DrawsTheWallAndTheForcesOnIt)
{
  VesselDrawing drawing;
  EXPECT_EQ(drawing.setVessel(tetrahedron(), {}), "");
  EXPECT_EQ(drawing.wall().triangles.size(), 12U);
  EXPECT_EQ(drawing.setForces(forceOnTriangle(2, 0.3F), HeatQuantity::kPeak, 0.0), "");
  EXPECT_FALSE(drawing.heat().triangles.empty());
  EXPECT_DOUBLE_EQ(drawing.fullScale(), 0.5);  // follows the scene
  EXPECT_EQ(drawing.setForces(forceOnTriangle(2, 0.3F), HeatQuantity::kPeak, 0.1), "");
  EXPECT_DOUBLE_EQ(drawing.fullScale(), 0.1);
}

TEST(VesselDrawing, DrawsNothingForInvalidMeshes)
{
  VesselDrawing drawing;
  EXPECT_EQ(drawing.setVessel({}, {}), "empty");
  VesselMesh message = tetrahedron();
  message.mesh.triangles[0].vertex_indices[1] = 4000000000U;
  EXPECT_NE(drawing.setVessel(message, {}), "");
  message = tetrahedron();
  message.mesh.vertices[1].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(drawing.setVessel(message, {}), "not finite");
  EXPECT_TRUE(drawing.wall().positions.empty());
}

TEST(VesselDrawing, DrawsNoForcesOfAnotherVesselAndNoInvalidOnes)
{
  VesselDrawing drawing;
  EXPECT_NE(drawing.setForces(forceOnTriangle(2, 0.3F), HeatQuantity::kPeak, 0.0), "");
  drawing.setVessel(tetrahedron(), {});
  ContactForceMap map = forceOnTriangle(2, 0.3F);
  map.content_hash = 43;
  EXPECT_NE(drawing.setForces(map, HeatQuantity::kPeak, 0.0), "");
  map = forceOnTriangle(2, std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(drawing.setForces(map, HeatQuantity::kPeak, 0.0), "not finite");
  EXPECT_EQ(drawing.setForces(forceOnTriangle(2, 0.3F), HeatQuantity::kIntegral, 0.0), "inconsistent lengths");
  EXPECT_EQ(drawing.setForces(forceOnTriangle(77, 0.3F), HeatQuantity::kPeak, 0.0), "");  // no such triangle
  EXPECT_TRUE(drawing.heat().positions.empty());
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
