#include "vessel/anatomy/tube.h"

#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/Geometry>

#include "common/error.h"
#include "geometry/closest_point_on_triangle.h"
#include "geometry/loop_subdivision.h"
#include "geometry/mesh_distance.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::vessel
{
namespace
{

TubeShape bentTube()
{
  TubeShape shape;
  shape.radius = 3e-3;
  shape.facet_length = 1e-3;
  shape.facets_around = 32;
  shape.pieces = {{0.05, 0.0, 0.0}, {0.5 * M_PI * 0.03, 1.0 / 0.03, 0.0}, {0.05, 0.0, 0.0}};
  return shape;
}

TEST(Tube, IsWatertightAndOfGenusZero)
{
  const MeshReport report = checkMesh(tubeMesh(bentTube()));
  EXPECT_EQ(report.summary(), "");
  EXPECT_EQ(report.genus, 0);
}

TEST(Tube, HasTheVolumeOfASweptPolygon)
{
  // Pappus: the volume is the area of the cross-section times the path of its centroid, minus the sagitta of the rings.
  const TubeShape shape = bentTube();
  const double area = 0.5 * 32 * std::sin(2.0 * M_PI / 32) * 9e-6;
  const double length = 4.0 * 3e-3 + 0.1 + 0.5 * M_PI * 0.03;
  EXPECT_NEAR(tubeMesh(shape).signedVolume() / (area * length), 1.0, 1e-4);
}

TEST(Tube, EndsAtTheEndOfTheBend)
{
  const CentrelineTree tree = tubeCentreline(bentTube());
  const Eigen::Vector3d end = tree.branches[0].points.back();
  EXPECT_NEAR((end - Eigen::Vector3d(0.03 + 0.05, 0.0, 0.05 + 0.03)).norm(), 0.0, 1e-12);
  const Eigen::Vector3d start = tree.branches[0].points.front();
  EXPECT_NEAR((start - Eigen::Vector3d(0.0, 0.0, -kTubeRunIn * 3e-3)).norm(), 0.0, 1e-12);
}

TEST(Tube, BendsInTheSpecifiedPlane)
{
  TubeShape shape = bentTube();
  shape.pieces[1].plane_angle = 0.5 * M_PI;
  const Eigen::Vector3d end = tubeCentreline(shape).branches[0].points.back();
  EXPECT_NEAR((end - Eigen::Vector3d(0.0, 0.08, 0.08)).norm(), 0.0, 1e-12);
}

TEST(Tube, HasTheSpecifiedPose)
{
  TubeShape shape = bentTube();
  const Eigen::AngleAxisd turn(1.1, Eigen::Vector3d(1, 2, 3).normalized());
  const Eigen::Vector3d position(0.1, -0.2, 0.3);
  TubeShape moved = shape;
  moved.position = position;
  moved.direction = turn * shape.direction;
  moved.up = turn * (shape.up + 0.4 * shape.direction);
  const geometry::TriangleMesh a = tubeMesh(shape);
  const geometry::TriangleMesh b = tubeMesh(moved);
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  for (std::size_t v = 0; v < a.vertices.size(); ++v)
    EXPECT_LT((turn * a.vertices[v] + position - b.vertices[v]).norm(), 1e-12);
}

TEST(Tube, HasItsVerticesOnTheWallAroundItsAxis)
{
  const TubeShape shape = bentTube();
  const geometry::TriangleMesh mesh = tubeMesh(shape);
  const geometry::MeshDistance distance(mesh);
  const CentrelineBranch axis = tubeCentreline(shape).branches[0];
  for (std::size_t k = 8; k + 8 < axis.points.size(); ++k)
  {
    const double inscribed = distance.closest(axis.points[k]).distance;
    EXPECT_LE(inscribed, 3e-3);
    EXPECT_GE(inscribed, 3e-3 * std::cos(M_PI / 32) - 1e-9 - 3e-5);
  }
}

TEST(Tube, LimitsTheFacetLength)
{
  const TubeShape shape = bentTube();
  const geometry::TriangleMesh mesh = tubeMesh(shape);
  const double around = 2.0 * 3e-3 * std::sin(M_PI / 32);
  for (std::size_t t = 0; t + 64 < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      EXPECT_LE((mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])] -
                 mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][(k + 1) % 3])])
                    .norm(),
                std::hypot(1e-3, around) + 1e-9);
}

TEST(Tube, RejectsInvalidShapes)
{
  TubeShape shape = bentTube();
  shape.pieces[1].curvature = 1.0 / 2e-3;
  EXPECT_THROW(tubeMesh(shape), InputError);
  shape = bentTube();
  shape.pieces.clear();
  EXPECT_THROW(tubeMesh(shape), InputError);
  shape = bentTube();
  shape.radius = -1.0;
  EXPECT_THROW(tubeMesh(shape), InputError);
  shape = bentTube();
  shape.up = shape.direction;
  EXPECT_THROW(tubeMesh(shape), InputError);
}

TEST(Subdivision, MidpointSubdivisionPreservesTheSurface)
{
  const geometry::TriangleMesh mesh = tubeMesh(bentTube());
  const geometry::TriangleMesh fine = geometry::midpointSubdivision(mesh, 2);
  EXPECT_EQ(fine.triangles.size(), 16 * mesh.triangles.size());
  EXPECT_EQ(checkMesh(fine).summary(), "");
  EXPECT_NEAR(fine.signedVolume() / mesh.signedVolume(), 1.0, 1e-12);
  const geometry::MeshDistance distance(mesh);
  for (std::size_t v = 0; v < fine.vertices.size(); v += 97)
    EXPECT_LT(distance.closest(fine.vertices[v]).distance, 1e-15);
}

/** Largest dihedral angle between adjacent faces in a section of the tube without caps. */
double largestAngle(const geometry::TriangleMesh& mesh)
{
  double largest = 0.0;
  const auto normal = [&mesh](std::size_t t)
  {
    const auto at = [&](int k) { return mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])]; };
    return Eigen::Vector3d((at(1) - at(0)).cross(at(2) - at(0)).normalized());
  };
  for (std::size_t a = 0; a < mesh.triangles.size(); ++a)
  {
    const double z = mesh.vertices[static_cast<std::size_t>(mesh.triangles[a][0])].z();
    if (z < 0.0 || z > 0.01)
      continue;
    for (std::size_t b = a + 1; b < std::min(a + 300, mesh.triangles.size()); ++b)
    {
      int shared = 0;
      for (int k = 0; k < 3; ++k)
        shared += (mesh.triangles[b].array() == mesh.triangles[a][k]).any() ? 1 : 0;
      if (shared == 2)
        largest = std::max(largest, std::acos(std::min(1.0, normal(a).dot(normal(b)))));
    }
  }
  return largest;
}

TEST(Subdivision, LoopSubdivisionSmoothsAndStaysWatertight)
{
  const geometry::TriangleMesh mesh = tubeMesh(bentTube());
  const geometry::TriangleMesh smooth = geometry::loopSubdivision(mesh, 1);
  EXPECT_EQ(smooth.triangles.size(), 4 * mesh.triangles.size());
  EXPECT_EQ(checkMesh(smooth).summary(), "");
  EXPECT_LT(largestAngle(smooth), 0.65 * largestAngle(mesh));
  EXPECT_NEAR(smooth.signedVolume() / mesh.signedVolume(), 1.0, 0.02);
}

TEST(MeshDistance, AgreesWithBruteForce)
{
  const geometry::TriangleMesh mesh = tubeMesh(bentTube());
  const geometry::MeshDistance distance(mesh);
  for (int k = 0; k < 200; ++k)
  {
    const Eigen::Vector3d p(0.06 * std::sin(1.3 * k), 0.01 * std::cos(2.1 * k), 0.05 + 0.06 * std::sin(0.7 * k + 1));
    double brute = 1e300;
    for (const Eigen::Vector3i& t : mesh.triangles)
      brute = std::min(brute, (geometry::closestPointOnTriangle(p, mesh.vertices[static_cast<std::size_t>(t[0])],
                                                                mesh.vertices[static_cast<std::size_t>(t[1])],
                                                                mesh.vertices[static_cast<std::size_t>(t[2])])
                                   .point -
                               p)
                                  .norm());
    EXPECT_DOUBLE_EQ(distance.closest(p).distance, brute);
    EXPECT_EQ(distance.closest(p, 0.99 * brute).triangle, -1);
  }
}

TEST(MeshDistance, HasWindingNumberOneInside)
{
  const geometry::TriangleMesh mesh = tubeMesh(bentTube());
  EXPECT_NEAR(geometry::windingNumber(mesh, {0, 0, 0.02}), 1.0, 1e-9);
  EXPECT_NEAR(geometry::windingNumber(mesh, {0.0, 0.004, 0.02}), 0.0, 1e-9);
}

TEST(MeshDistance, RayHitsTheOppositeWallOfTheTube)
{
  const geometry::TriangleMesh mesh = tubeMesh(bentTube());
  const geometry::MeshDistance distance(mesh);
  EXPECT_NEAR(distance.rayHit({0, 0, 0.02}, Eigen::Vector3d::UnitX()), 3e-3, 2e-5);
  EXPECT_NEAR(distance.rayHit({0, 0, 0.02}, -Eigen::Vector3d::UnitZ()), 0.032, 1e-9);
  EXPECT_EQ(distance.rayHit({0, 0.1, 0.02}, Eigen::Vector3d::UnitY()), -1.0);
}

}  // namespace
}  // namespace endovascular_sim::vessel
