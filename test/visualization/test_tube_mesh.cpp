#include "visualization/tube_mesh.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace endovascular_sim::visualization
{
namespace
{

std::vector<Eigen::Vector3d> helix(std::size_t count)
{
  std::vector<Eigen::Vector3d> nodes;
  for (std::size_t i = 0; i < count; ++i)
  {
    const double t = 0.1 * static_cast<double>(i);
    nodes.emplace_back(0.02 * std::cos(t), 0.02 * std::sin(t), 0.005 * t);
  }
  return nodes;
}

/** Six times the enclosed volume by the divergence theorem; positive for outward normals. */
double sixVolumes(const TubeMesh& mesh)
{
  double sum = 0.0;
  for (std::size_t i = 0; i + 2 < mesh.corners.size(); i += 3)
    sum += mesh.corners[i].dot(mesh.corners[i + 1].cross(mesh.corners[i + 2]));
  return sum;
}

TEST(TubeMesh, OfAStraightWireHasTheVolumeOfAPrismAndOutwardNormals)
{
  const std::vector<Eigen::Vector3d> nodes{{0, 0, 0}, {0, 0, 0.05}, {0, 0, 0.1}};
  const TubeMesh mesh = tubeMesh(nodes, {1e-3, 1e-3, 1e-3}, 8);
  const double octagon = 0.5 * 8 * std::sin(2 * M_PI / 8) * 1e-6;
  EXPECT_NEAR(sixVolumes(mesh) / 6.0, octagon * 0.1, 1e-15);
}

TEST(TubeMesh, HasAllCornersOneRadiusFromTheirNodes)
{
  const std::vector<Eigen::Vector3d> nodes = helix(60);
  std::vector<double> radius(nodes.size());
  for (std::size_t i = 0; i < radius.size(); ++i)
    radius[i] = 2e-4 + 1e-6 * static_cast<double>(i);
  const TubeMesh mesh = tubeMesh(nodes, radius, 8, 2.0);
  ASSERT_EQ(mesh.corners.size(), 3U * (2U * 8U * 59U + 2U * 8U));
  for (std::size_t c = 0; c < mesh.corners.size(); ++c)
  {
    const std::size_t node = mesh.node_of_corner[c];
    const double distance = (mesh.corners[c] - nodes[node]).norm();
    const bool centre_of_an_end = distance == 0.0 && (node == 0 || node + 1 == nodes.size());
    EXPECT_TRUE(centre_of_an_end || std::abs(distance - 2.0 * radius[node]) < 1e-12);
  }
}

TEST(TubeMesh, ClosesItsSurface)
{
  // The vector areas of a closed surface sum to zero.
  const TubeMesh mesh = tubeMesh(helix(40), std::vector<double>(40, 1e-3), 8);
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i + 2 < mesh.corners.size(); i += 3)
    area += (mesh.corners[i + 1] - mesh.corners[i]).cross(mesh.corners[i + 2] - mesh.corners[i]);
  EXPECT_LT(area.norm(), 1e-15);
  EXPECT_GT(sixVolumes(mesh), 0.0);
}

TEST(TubeMesh, TransportsItsFrameWithoutTwist)
{
  const std::vector<Eigen::Vector3d> nodes = helix(200);
  const std::vector<Eigen::Vector3d> normals = transportedNormals(nodes);
  for (std::size_t i = 1; i + 1 < nodes.size(); ++i)
  {
    const Eigen::Vector3d tangent =
        ((nodes[i] - nodes[i - 1]).normalized() + (nodes[i + 1] - nodes[i]).normalized()).normalized();
    EXPECT_NEAR(normals[i].dot(tangent), 0.0, 1e-9);
    // Rotation-minimising frame: the normal changes along the tangent only. Its change normal to tangent and normal is
    // therefore of third order (curvature 50/m, edge 2 mm).
    const Eigen::Vector3d across = tangent.cross(normals[i]);
    EXPECT_LT(std::abs((normals[i] - normals[i - 1]).dot(across)), 1e-2);
  }
}

TEST(TubeMesh, OfAPlanarCurveRetainsTheNormalOfThePlane)
{
  std::vector<Eigen::Vector3d> nodes;
  for (int i = 0; i < 50; ++i)
    nodes.emplace_back(std::cos(0.1 * i), std::sin(0.1 * i), 0.0);
  const std::vector<Eigen::Vector3d> normals = transportedNormals(nodes);
  for (const Eigen::Vector3d& normal : normals)
    EXPECT_NEAR(normal.z(), normals.front().z(), 1e-12);
}

TEST(TubeMesh, SkipsCoincidingAndInvalidNodes)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Eigen::Vector3d> nodes{{0, 0, 0}, {0, 0, 0}, {nan, 0, 0}, {0, 0, 0.1}};
  const TubeMesh mesh = tubeMesh(nodes, {1e-3, 1e-3, 1e-3, 1e-3}, 3);
  ASSERT_FALSE(mesh.corners.empty());
  for (const Eigen::Vector3d& corner : mesh.corners)
    EXPECT_TRUE(corner.allFinite());
}

TEST(TubeMesh, IsEmptyWithoutAnEdge)
{
  EXPECT_TRUE(tubeMesh({}, {}, 8).corners.empty());
  EXPECT_TRUE(tubeMesh({{0, 0, 0}}, {1e-3}, 8).corners.empty());
  EXPECT_TRUE(tubeMesh({{0, 0, 0}, {0, 0, 1}}, {1e-3}, 8).corners.empty());
}

TEST(TubeMesh, HandlesAReversalOfTheCurve)
{
  const TubeMesh mesh = tubeMesh({{0, 0, 0}, {0, 0, 0.1}, {0, 0, 0.05}}, {1e-3, 1e-3, 1e-3}, 8);
  for (const Eigen::Vector3d& corner : mesh.corners)
    EXPECT_TRUE(corner.allFinite());
}

TEST(ForceColour, ChangesFromGreyToRedAndSaturates)
{
  EXPECT_FLOAT_EQ(forceColour(0.0, 0.1).red, 0.75F);
  EXPECT_FLOAT_EQ(forceColour(0.1, 0.1).red, 0.85F);
  EXPECT_FLOAT_EQ(forceColour(0.1, 0.1).green, 0.05F);
  EXPECT_FLOAT_EQ(forceColour(7.0, 0.1).blue, forceColour(0.1, 0.1).blue);
  EXPECT_GT(forceColour(0.03, 0.1).green, forceColour(0.08, 0.1).green);
  EXPECT_FLOAT_EQ(forceColour(std::numeric_limits<double>::quiet_NaN(), 0.1).red, 0.75F);
}

}  // namespace
}  // namespace endovascular_sim::visualization
