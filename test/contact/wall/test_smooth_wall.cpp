#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "contact/wall/smooth_wall.h"
#include "test/contact/contact_fixtures.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::contact
{
namespace
{

constexpr double kRadius = 3e-3;  // m

geometry::TriangleMesh straightTube(int facets_around)
{
  vessel::TubeShape shape;
  shape.radius = kRadius;
  shape.facets_around = facets_around;
  shape.facet_length = 2e-3;
  shape.pieces = {{0.03, 0.0, 0.0}};
  return vessel::tubeMesh(shape);
}

Eigen::Vector3d randomWeights(std::mt19937& random)
{
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const double a = share(random);
  const double b = share(random);
  return a + b < 1.0 ? Eigen::Vector3d(1.0 - a - b, a, b) : Eigen::Vector3d(a + b - 1.0, 1.0 - a, 1.0 - b);
}

TEST(SmoothWall, OfATubeIsTheCylinder)
{
  for (int facets : {8, 12, 16, 48})
  {
    const Wall wall(refinedForSmoothWall(straightTube(facets)));
    const SmoothWall smooth(wall);
    std::mt19937 random(1);
    double worst = 0.0;
    double worst_normal = 0.0;
    for (int t = 0; t < static_cast<int>(wall.triangles.size()); ++t)
    {
      const Eigen::Vector3d& corner = wall.vertices[wall.triangles[t][0]];
      if (corner.z() < 0.0 || corner.z() > 0.02)
        continue;
      const SmoothWall::Point point = smooth.at(t, randomWeights(random));
      const Eigen::Vector3d radial(point.position.x(), point.position.y(), 0.0);
      worst = std::max(worst, std::abs(radial.norm() - kRadius));
      worst_normal = std::max(worst_normal, (point.normal + radial.normalized()).norm());
      EXPECT_NEAR((point.curvature * Eigen::Vector3d::UnitZ()).norm(), 0.0, 0.05 / kRadius);
      EXPECT_NEAR(point.curvature.trace(), 1.0 / kRadius, 0.05 / kRadius);
    }
    EXPECT_LT(worst, facets < 16 ? 5e-6 : 1e-6) << facets;
    EXPECT_LT(worst_normal, facets < 16 ? 1e-2 : 2e-3) << facets;
  }
}

TEST(SmoothWall, BothTrianglesOfASmoothEdgeGiveTheSamePointAndHardlyDifferentNormals)
{
  const Wall wall(bumpyTube(0.1));
  const SmoothWall smooth(wall);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  int smooth_edges = 0;
  std::vector<double> turns;  // rad, by which the normal turns across an edge
  for (std::size_t e = 0; e < wall.edges.size(); ++e)
  {
    const WallEdge& edge = wall.edges[e];
    const double t = share(random);
    std::array<SmoothWall::Point, 2> points;
    for (int side = 0; side < 2; ++side)
    {
      const Eigen::Vector3i& corners = wall.triangles[edge.triangles[side]];
      Eigen::Vector3d weights = Eigen::Vector3d::Zero();
      for (int k = 0; k < 3; ++k)
        weights[k] = corners[k] == edge.vertices[0] ? 1.0 - t : corners[k] == edge.vertices[1] ? t : 0.0;
      points[side] = smooth.at(edge.triangles[side], weights);
    }
    EXPECT_LT((points[0].position - points[1].position).norm(), 1e-15);
    if (smooth.isSharp(static_cast<int>(e)))
      continue;
    ++smooth_edges;
    const double turn = (points[0].normal - points[1].normal).norm();
    turns.push_back(turn);
  }
  std::sort(turns.begin(), turns.end());
  EXPECT_LT(turns[turns.size() / 2], 0.01);
  EXPECT_LT(turns.back(), 0.2);  // the bumps of one facet: the quadrics disagree by up to 20°
  EXPECT_GT(smooth_edges, static_cast<int>(0.8 * static_cast<double>(wall.edges.size())));
}

TEST(SmoothWall, TangentsAgreeWithFiniteDifferences)
{
  const Wall wall(bumpyTube(0.1));
  const SmoothWall smooth(wall);
  constexpr double kStep = 1e-6;
  std::mt19937 random(4);
  for (int t = 0; t < static_cast<int>(wall.triangles.size()); ++t)
  {
    const Eigen::Vector3d weights = randomWeights(random);
    const SmoothWall::Point point = smooth.at(t, weights);
    EXPECT_LT((point.position - smooth.positionAt(t, weights)).norm(), 1e-15);
    for (int k = 0; k < 2; ++k)
    {
      const Eigen::Vector3d step = kStep * (Eigen::Vector3d::Unit(k + 1) - Eigen::Vector3d::Unit(0));
      const Eigen::Vector3d change =
          (smooth.positionAt(t, weights + step) - smooth.positionAt(t, weights - step)) / (2.0 * kStep);
      EXPECT_LT((point.tangents.col(k) - change).norm(), 1e-6 * change.norm());
      EXPECT_LT(std::abs(point.normal.dot(point.tangents.col(k))), 1e-12 * change.norm());
    }
    EXPECT_GT(point.normal.dot(wall.normals[t]), 0.0);
  }
}

TEST(SmoothWall, IsNoFartherFromItsFacetsThanTheDeviation)
{
  const Wall wall(bumpyTube(0.1));
  const SmoothWall smooth(wall);
  std::mt19937 random(3);
  for (int t = 0; t < static_cast<int>(wall.triangles.size()); ++t)
    for (int trial = 0; trial < 5; ++trial)
    {
      const Eigen::Vector3d weights = randomWeights(random);
      Eigen::Vector3d facet = Eigen::Vector3d::Zero();
      for (int k = 0; k < 3; ++k)
        facet += weights[k] * wall.vertices[wall.triangles[t][k]];
      EXPECT_LE((smooth.positionAt(t, weights) - facet).norm(), smooth.deviationOf(t) + 1e-15);
      EXPECT_LE(smooth.deviationOf(t), smooth.deviation());
    }
}

TEST(SmoothWall, KeepsTheFlatCapsAndTheRimOfATube)
{
  const Wall wall(straightTube(16));
  const SmoothWall smooth(wall);
  for (std::size_t e = 0; e < wall.edges.size(); ++e)
    if (std::abs(wall.edges[e].reflex_angle) > 1.4)
    {
      EXPECT_TRUE(smooth.isSharp(static_cast<int>(e)));
    }
  double highest = 0.0;
  for (const Eigen::Vector3d& v : wall.vertices)
    highest = std::max(highest, v.z());
  for (const Eigen::Vector3d& v : tessellate(smooth, 4).vertices)
    EXPECT_LE(v.z(), highest + 1e-12);
}

TEST(SmoothWall, HasAClosedTessellation)
{
  EXPECT_TRUE(vessel::checkMesh(tessellate(SmoothWall(Wall(bentTube())), 3)).clean());
}

TEST(SmoothWall, QuadricsOfDifferentResolutionsAgreeOnATubeAndDisagreeAtARim)
{
  const Wall wall(straightTube(7));
  const std::vector<double> angles = quadricDisagreement(wall, fitVertexQuadrics(wall));
  double highest = 0.0;
  for (const Eigen::Vector3d& v : wall.vertices)
    highest = std::max(highest, v.z());
  for (std::size_t v = 0; v < angles.size(); ++v)
  {
    const double z = wall.vertices[v].z();
    if (z > 0.0 && z < highest - 5e-3)
    {
      EXPECT_LT(angles[v], 0.02);
    }
    else if (z > highest - 1e-9 && wall.vertices[v].head<2>().norm() > 0.9 * kRadius)
    {
      EXPECT_GT(angles[v], 0.35);
    }
  }
}

TEST(RefinedForSmoothWall, LeavesAMeshOfManyFacetsAndRefinesACoarseOne)
{
  const geometry::TriangleMesh fine = straightTube(16);
  EXPECT_EQ(refinedForSmoothWall(fine).triangles.size(), fine.triangles.size());
  const geometry::TriangleMesh coarse = straightTube(8);
  EXPECT_GT(refinedForSmoothWall(coarse).triangles.size(), coarse.triangles.size());
}

}  // namespace
}  // namespace endovascular_sim::contact
