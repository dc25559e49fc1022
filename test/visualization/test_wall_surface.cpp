#include "visualization/wall_surface.h"

#include <limits>

#include <gtest/gtest.h>

namespace endovascular_sim::visualization
{
namespace
{

/** Octahedron of radius 1. */
geometry::TriangleMesh octahedron()
{
  geometry::TriangleMesh mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

TEST(WallSurface, HasSmoothOutwardNormalsAtTheVerticesOfTheMesh)
{
  const Surface surface = wallSurface(octahedron(), {{1.0F, 0.0F, 0.0F}, 0.4F});
  ASSERT_EQ(surface.positions.size(), 6U);
  EXPECT_EQ(surface.triangles.size(), 24U);
  for (std::size_t i = 0; i < surface.positions.size(); ++i)
    EXPECT_NEAR((surface.normals[i] - surface.positions[i]).norm(), 0.0F, 1e-6F);
}

TEST(WallSurface, IsFiniteForDegenerateTrianglesAndUnusedVertices)
{
  geometry::TriangleMesh mesh = octahedron();
  mesh.vertices.emplace_back(5, 5, 5);
  mesh.vertices.emplace_back(6, 6, 6);
  mesh.triangles.emplace_back(7, 7, 7);
  for (const Eigen::Vector3f& normal : wallSurface(mesh, {}).normals)
    EXPECT_TRUE(normal.allFinite());
}

TEST(ProblemOfMesh, NamesWhatCannotBeDrawn)
{
  EXPECT_EQ(problemOfMesh(octahedron()), nullptr);
  EXPECT_STREQ(problemOfMesh({}), "empty");
  geometry::TriangleMesh mesh = octahedron();
  mesh.triangles[3].x() = 6;
  EXPECT_STREQ(problemOfMesh(mesh), "a triangle refers to a vertex that does not exist");
  mesh.triangles[3].x() = -1;
  EXPECT_STREQ(problemOfMesh(mesh), "a triangle refers to a vertex that does not exist");
  mesh = octahedron();
  mesh.vertices[2].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_STREQ(problemOfMesh(mesh), "not finite");
}

TEST(CutAway, OpensTheWallAroundThePointOnly)
{
  Surface surface = wallSurface(octahedron(), {{1.0F, 0.0F, 0.0F}, 0.4F});
  cutAway({1.0, 0.0, 0.0}, 1.0, 0.4F, surface);
  EXPECT_EQ(surface.colours[0].opacity, 0.0F);
  for (std::size_t i = 1; i < 6; ++i)
    EXPECT_EQ(surface.colours[i].opacity, 0.4F);
  cutAway({0.25, 0.0, 0.0}, 1.0, 0.4F, surface);  // three quarters of the radius away: half of the opacity
  EXPECT_NEAR(surface.colours[0].opacity, 0.2F, 1e-6F);
  cutAway({1.0, 0.0, 0.0}, 0.0, 0.4F, surface);
  EXPECT_EQ(surface.colours[0].opacity, 0.4F);
}

TEST(HeatColour, IsTransparentWithoutForceAndRedAtTheFullScale)
{
  EXPECT_EQ(heatColour(0.0, 0.3).opacity, 0.0F);
  EXPECT_EQ(heatColour(std::numeric_limits<double>::quiet_NaN(), 0.3).opacity, 0.0F);
  EXPECT_NEAR(heatColour(0.05, 0.3).opacity, 0.5F, 1e-6F);
  EXPECT_EQ(heatColour(0.3, 0.3).opacity, 1.0F);
  EXPECT_EQ(heatColour(0.3, 0.3).colour.red, forceColour(0.3, 0.3).red);
}

TEST(BranchLabel, HasSpacesInPlaceOfUnderscores)
{
  EXPECT_EQ(branchLabel("right_common_femoral"), "right common femoral");
}

}  // namespace
}  // namespace endovascular_sim::visualization
