#include "rviz_plugin/model/vessel_drawing.h"

#include <algorithm>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "test/rviz_plugin/moved_patient.h"

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

/** Positions of a surface; equal bits are equal. */
bool isSame(const visualization::Surface& a, const visualization::Surface& b)
{
  return a.positions == b.positions && a.normals == b.normals && a.triangles == b.triangles;
}

TEST(VesselDrawing, VerticesWithinTheFadeLieWhereTheMapPutsThem)
{
  VesselDrawing rest, drawing;
  rest.setVessel(tetrahedron(), {});
  drawing.setVessel(tetrahedron(), {});
  const motion::MotionMap map = movedPatient();
  EXPECT_TRUE(drawing.move(map));
  EXPECT_EQ(drawing.movingVertices(), std::vector<std::uint32_t>{0}) << "the others are 10 mm away";
  const Eigen::Vector3f moved = map.position(Eigen::Vector3d::Zero()).cast<float>();
  EXPECT_GT(moved.norm(), 1e-3F);
  EXPECT_EQ(drawing.wall().positions[0], moved);
  for (std::size_t k = 1; k < 4; ++k)
    EXPECT_EQ(drawing.wall().positions[k], rest.wall().positions[k]);
}

TEST(VesselDrawing, TheHeatMapLiesWhereTheMapPutsIt)
{
  VesselDrawing rest, drawing;
  for (VesselDrawing* each : {&rest, &drawing})
  {
    each->setVessel(tetrahedron(), {});
    each->setForces(forceOnTriangle(1, 0.3F), HeatQuantity::kPeak, 0.0);
  }
  const motion::MotionMap map = movedPatient();
  drawing.move(map);
  ASSERT_EQ(drawing.heat().positions.size(), rest.heat().positions.size());
  float largest = 0.0F;
  for (std::size_t k = 0; k < rest.heat().positions.size(); ++k)
  {
    const Eigen::Vector3f moved = map.position(rest.heat().positions[k].cast<double>()).cast<float>();
    EXPECT_LT((drawing.heat().positions[k] - moved).norm(), 1e-8F);
    largest = std::max(largest, (moved - rest.heat().positions[k]).norm());
  }
  EXPECT_GT(largest, 1e-3F);
}

TEST(VesselDrawing, APatientAtRestKeepsEveryBit)
{
  VesselDrawing rest, drawing;
  for (VesselDrawing* each : {&rest, &drawing})
  {
    each->setVessel(tetrahedron(), {});
    each->setForces(forceOnTriangle(1, 0.3F), HeatQuantity::kPeak, 0.0);
  }
  EXPECT_FALSE(drawing.move(nodes::restingMap()));
  EXPECT_FALSE(drawing.move(movedPatient(0.0)));
  EXPECT_TRUE(isSame(drawing.wall(), rest.wall()));
  EXPECT_TRUE(drawing.move(movedPatient()));
  EXPECT_FALSE(isSame(drawing.wall(), rest.wall()));
  EXPECT_TRUE(drawing.move(nodes::restingMap())) << "it returns to rest";
  EXPECT_TRUE(isSame(drawing.wall(), rest.wall()));
  EXPECT_TRUE(isSame(drawing.heat(), rest.heat()));
  EXPECT_FALSE(drawing.move(nodes::restingMap()));
}

TEST(VesselDrawing, ANewWallAndNewForcesHaveTheMotion)
{
  VesselDrawing before, after;
  before.setVessel(tetrahedron(), {});
  before.setForces(forceOnTriangle(1, 0.3F), HeatQuantity::kPeak, 0.0);
  before.move(movedPatient());
  after.move(movedPatient());
  after.setVessel(tetrahedron(), {});
  after.setForces(forceOnTriangle(1, 0.3F), HeatQuantity::kPeak, 0.0);
  EXPECT_TRUE(isSame(before.wall(), after.wall()));
  EXPECT_TRUE(isSame(before.heat(), after.heat()));
}

TEST(VesselDrawing, VerticesOutsideOfAnotherFadeReturnToRest)
{
  VesselDrawing rest, drawing;
  rest.setVessel(tetrahedron(), {});
  drawing.setVessel(tetrahedron(), {});
  drawing.move(movedPatient());
  MotionState elsewhere = motionMessage(0);
  elsewhere.fade_centre.x = 0.01;
  drawing.move(nodes::fromMessage(elsewhere));
  EXPECT_EQ(drawing.movingVertices(), std::vector<std::uint32_t>{1});
  EXPECT_EQ(drawing.wall().positions[0], rest.wall().positions[0]);
  EXPECT_NE(drawing.wall().positions[1], rest.wall().positions[1]);
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
