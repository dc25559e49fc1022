#include "contact/wall/facet_forces.h"

#include <random>

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace endovascular_sim::contact
{
namespace
{

/** Two squares along x that meet on the x axis and rise at 45° on both sides: the lumen lies above. Triangles 0 and 1
 * push towards +y, 2 and 3 towards −y; 0 and 3 share the edge on the axis. */
geometry::TriangleMesh trough()
{
  geometry::TriangleMesh mesh;
  mesh.vertices = {{0.0, 0.0, 0.0},  {1.0, 0.0, 0.0}, {1.0, -1.0, 1.0},
                   {0.0, -1.0, 1.0}, {1.0, 1.0, 1.0}, {0.0, 1.0, 1.0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 5, 4}, {0, 4, 1}};
  return mesh;
}

/** Three triangles without common vertices, whose normals into the lumen are given. */
geometry::TriangleMesh facetsWith(const Eigen::Matrix3d& normals)
{
  geometry::TriangleMesh mesh;
  for (int k = 0; k < 3; ++k)
  {
    const Eigen::Vector3d along = normals.col(k).unitOrthogonal();
    const Eigen::Vector3d at(3.0 * k, 0.0, 0.0);
    mesh.triangles.emplace_back(3 * k, 3 * k + 2, 3 * k + 1);
    mesh.vertices.insert(mesh.vertices.end(), {at, at + along, at + normals.col(k).cross(along)});
  }
  return mesh;
}

}  // namespace

TEST(FacetForces, OfThreeFacetsEqualTheSolutionOfTheLinearSystem)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int of_three = 0;
  for (int k = 0; k < 1000; ++k)
  {
    Eigen::Matrix3d normals;
    for (int j = 0; j < 3; ++j)
      normals.col(j) = Eigen::Vector3d(0.3 * uniform(random), 0.3 * uniform(random), 1.0).normalized();
    const Eigen::Vector3d push(1.5 + uniform(random), 1.5 + uniform(random), 1.5 + uniform(random));
    const Eigen::Vector3d force = normals * push;
    const FacetForces::Shares shares = FacetForces(facetsWith(normals)).divide(force, std::array<int, 3>{0, 1, 2});
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t j = 0; j < shares.count; ++j)
      sum += shares.share[j].force * normals.col(shares.share[j].triangle);
    const Eigen::Vector3d expected = normals.fullPivLu().solve(force);
    EXPECT_NEAR((sum - force).norm(), 0.0, 1e-6 * force.norm()) << "the tolerated rest";
    if (shares.count < 3)  // two of them make up the force
      continue;
    ++of_three;
    EXPECT_NEAR((sum - force).norm(), 0.0, 1e-12);
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_NEAR(shares.share[j].force, expected[shares.share[j].triangle], 1e-9);
  }
  EXPECT_GT(of_three, 900);
}

TEST(FacetForces, OfTwoTouchedFacetsAddUpToTheVectorOfTheContact)
{
  const FacetForces facets(trough());
  const double c = std::sqrt(0.5);
  const Eigen::Vector3d force = 3.0 * Eigen::Vector3d(0.0, c, c) + 1.0 * Eigen::Vector3d(0.0, -c, c);
  const FacetForces::Shares shares = facets.divide(force, std::array<int, 4>{1, 2, -1, -1});
  ASSERT_EQ(shares.count, 2U);
  EXPECT_EQ(shares.share[0].triangle, 1);
  EXPECT_NEAR(shares.share[0].force, 3.0, 1e-12);
  EXPECT_EQ(shares.share[1].triangle, 2);
  EXPECT_NEAR(shares.share[1].force, 1.0, 1e-12);
}

TEST(FacetForces, OfOneTouchedFacetNeedNoOther)
{
  const FacetForces facets(trough());
  const FacetForces::Shares shares = facets.divide({0.0, 1.0, 1.0}, std::array<int, 4>{0, 0, 3, 2});
  ASSERT_EQ(shares.count, 1U);
  EXPECT_EQ(shares.share[0].triangle, 0);
  EXPECT_NEAR(shares.share[0].force, std::sqrt(2.0), 1e-12);
}

// The normal of an edge of the mesh lies between those of its two triangles, of which the feature names one.
TEST(FacetForces, OfAnEdgeAreDividedBetweenItsTriangles)
{
  const FacetForces facets(trough());
  const FacetForces::Shares shares = facets.divide({0.0, 0.0, 2.0}, std::array<int, 1>{0});
  ASSERT_EQ(shares.count, 2U);
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_NEAR(shares.share[k].force, std::sqrt(2.0), 1e-12);
  EXPECT_EQ(shares.share[0].triangle + shares.share[1].triangle, 3);
}

TEST(FacetForces, NeverPullAndNeverNameAForeignTriangle)
{
  const FacetForces facets(trough());
  const FacetForces::Shares shares = facets.divide({0.0, 5.0, 1.0}, std::array<int, 4>{2, 0, 99, -1});
  ASSERT_EQ(shares.count, 1U);
  EXPECT_EQ(shares.share[0].triangle, 0);
  EXPECT_GT(shares.share[0].force, 0.0);
  EXPECT_EQ(facets.divide({0.0, 0.0, -1.0}, std::array<int, 1>{0}).count, 0U);
  EXPECT_EQ(facets.divide({0.0, 0.0, 1.0}, std::array<int, 1>{-1}).count, 0U);
}

// An inflated balloon touches the wall all round: its small force must not become large ones that cancel out.
TEST(FacetForces, OfFacetsThatFaceEachOtherAreOfTheSizeOfTheForce)
{
  for (const double slope : {1e-1, 1e-2, 1e-3, 1e-4})
  {
    Eigen::Matrix3d normals;
    normals << 0.0, 0.0, 1.0, 1.0, -1.0, 0.0, slope, slope, slope;
    normals.colwise().normalize();
    const FacetForces facets(facetsWith(normals));
    for (const Eigen::Vector3d& force : {Eigen::Vector3d(0.0, 0.0, 1.0), Eigen::Vector3d(0.3, 0.4, 1.0)})
    {
      const FacetForces::Shares shares = facets.divide(force, std::array<int, 3>{0, 1, 2});
      // A force across all normals may have no share; then the deepest triangle carries it (WallForceMap).
      EXPECT_TRUE(shares.count > 0U || force.head<2>().isZero()) << slope;
      for (std::size_t k = 0; k < shares.count; ++k)
        EXPECT_LE(shares.share[k].force, 2.0 * force.norm()) << slope;
    }
  }
}

}  // namespace endovascular_sim::contact
