#include "contact/narrow_phase/narrow_phase.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "test/contact/contact_fixtures.h"

namespace endovascular_sim::contact
{
namespace
{

constexpr double kCutoff = 0.7e-3;  // m

/** A coarse bent tube, whose inner side has reflex edges. */
class NarrowPhaseInATube : public testing::Test
{
protected:
  NarrowPhaseInATube()
  {
    for (std::size_t e = 0; e < wall_.edges.size(); ++e)
      if (wall_.edges[e].reflex_angle > 0.1)
        reflex_edge_ = static_cast<int>(e);
  }

  Eigen::Vector3d centroid(int triangle) const
  {
    const Eigen::Vector3i& c = wall_.triangles[triangle];
    return (wall_.vertices[c[0]] + wall_.vertices[c[1]] + wall_.vertices[c[2]]) / 3.0;
  }

  const WallEdge& reflexEdge() const { return wall_.edges[reflex_edge_]; }
  Eigen::Vector3d middle() const
  {
    return 0.5 * (wall_.vertices[reflexEdge().vertices[0]] + wall_.vertices[reflexEdge().vertices[1]]);
  }

  /** An edge of the wire perpendicular to the reflex edge, with its middle above the reflex edge. */
  NarrowPhase::WireEdge across(double height, double taper = 0.0) const
  {
    const Eigen::Vector3d along =
        (wall_.vertices[reflexEdge().vertices[1]] - wall_.vertices[reflexEdge().vertices[0]]).normalized();
    const Eigen::Vector3d half = 1e-3 * along.cross(reflexEdge().normal);
    const Eigen::Vector3d above = middle() + height * reflexEdge().normal;
    return {above - half, above + half, taper};
  }

  Wall wall_{bentTube()};
  WallBounds bounds_{wall_};
  NarrowPhase narrow_phase_{wall_, bounds_};
  NarrowPhase::Minimum minimum_;
  int reflex_edge_ = 0;
};

TEST_F(NarrowPhaseInATube, FindsTheFaceBelowAPoint)
{
  for (int t = 0; t < static_cast<int>(wall_.triangles.size()); ++t)
  {
    const Eigen::Vector3d foot = centroid(t);
    ASSERT_TRUE(narrow_phase_.faceFeature(foot + 0.5e-3 * wall_.normals[t], t, kCutoff, minimum_));
    EXPECT_FALSE(minimum_.outside);
    EXPECT_EQ(minimum_.feature.triangle, t);
    EXPECT_EQ(minimum_.feature.id, featureId(t, FeatureKind::kFace));
    EXPECT_NEAR(minimum_.feature.gap, 0.5e-3, 1e-12);
    EXPECT_NEAR(minimum_.distance, 0.5e-3, 1e-12);
    EXPECT_LT((minimum_.feature.point - foot).norm(), 1e-12);
    EXPECT_EQ(minimum_.feature.normal, wall_.normals[t]);
  }
}

TEST_F(NarrowPhaseInATube, ReportsAPointBehindAFaceAsOutside)
{
  ASSERT_TRUE(narrow_phase_.faceFeature(centroid(0) - 0.2e-3 * wall_.normals[0], 0, kCutoff, minimum_));
  EXPECT_TRUE(minimum_.outside);
  EXPECT_NEAR(minimum_.feature.gap, -0.2e-3, 1e-12);
}

TEST_F(NarrowPhaseInATube, FindsNothingBeyondTheCutoff)
{
  EXPECT_FALSE(narrow_phase_.faceFeature(centroid(0) + 0.71e-3 * wall_.normals[0], 0, kCutoff, minimum_));
  EXPECT_FALSE(narrow_phase_.edgeEdgeFeature(across(0.71e-3), reflex_edge_, kCutoff, minimum_));
}

TEST_F(NarrowPhaseInATube, FindsAReflexEdgeFromBothOfItsTriangles)
{
  for (int t : reflexEdge().triangles)
  {
    ASSERT_TRUE(narrow_phase_.faceFeature(middle() + 0.5e-3 * reflexEdge().normal, t, kCutoff, minimum_));
    EXPECT_EQ(minimum_.feature.id, featureId(reflex_edge_, FeatureKind::kEdge));
    EXPECT_EQ(minimum_.feature.triangle, reflexEdge().triangles[0]);
    EXPECT_NEAR(minimum_.feature.gap, 0.5e-3, 1e-12);
  }
}

TEST_F(NarrowPhaseInATube, RejectsAnEdgeThatIsNotReflex)
{
  for (const WallEdge& edge : wall_.edges)
  {
    if (edge.reflex_angle > -0.1)
      continue;
    const Eigen::Vector3d on_edge = 0.5 * (wall_.vertices[edge.vertices[0]] + wall_.vertices[edge.vertices[1]]);
    EXPECT_FALSE(narrow_phase_.faceFeature(on_edge + 0.5e-3 * edge.normal, edge.triangles[0], kCutoff, minimum_) &&
                 minimum_.feature.id % 3 == 1);
  }
}

TEST_F(NarrowPhaseInATube, FindsAReflexEdgeBetweenTheNodesOfAWireEdge)
{
  ASSERT_TRUE(narrow_phase_.edgeEdgeFeature(across(0.5e-3), reflex_edge_, kCutoff, minimum_));
  EXPECT_FALSE(minimum_.outside);
  EXPECT_NEAR(minimum_.feature.parameter, 0.5, 1e-9);
  EXPECT_NEAR(minimum_.feature.gap, 0.5e-3, 1e-12);
  EXPECT_LT((minimum_.feature.point - middle()).norm(), 1e-12);
}

TEST_F(NarrowPhaseInATube, ReportsAWireEdgeBehindAReflexEdgeAsOutsideUpToALimitedDepth)
{
  ASSERT_TRUE(narrow_phase_.edgeEdgeFeature(across(-0.3e-3), reflex_edge_, kCutoff, minimum_));
  EXPECT_TRUE(minimum_.outside);
  EXPECT_NEAR(minimum_.feature.gap, -0.3e-3, 1e-12);
  EXPECT_FALSE(narrow_phase_.edgeEdgeFeature(across(-0.41e-3), reflex_edge_, kCutoff, minimum_));
}

TEST_F(NarrowPhaseInATube, ShiftsTheContactOfATaperedWireTowardsItsWiderEnd)
{
  ASSERT_TRUE(narrow_phase_.edgeEdgeFeature(across(0.5e-3, 0.2e-3), reflex_edge_, kCutoff, minimum_));
  EXPECT_GT(minimum_.feature.parameter, 0.51);
}

TEST_F(NarrowPhaseInATube, GivesAClearanceRadiusToFacesOnly)
{
  narrow_phase_.edgeEdgeFeature(across(0.5e-3), reflex_edge_, kCutoff, minimum_);
  EXPECT_TRUE(std::isinf(narrow_phase_.clearanceRadius(minimum_.feature, Eigen::Vector3d::UnitZ(), 0.4e-3)));
  narrow_phase_.faceFeature(centroid(0) + 0.5e-3 * wall_.normals[0], 0, kCutoff, minimum_);
  const auto clearance = [&](double radius)
  { return narrow_phase_.clearanceRadius(minimum_.feature, Eigen::Vector3d::UnitZ(), radius); };
  ASSERT_TRUE(std::isfinite(clearance(0.4e-3)));
  EXPECT_NEAR(clearance(0.4e-3) - clearance(0.9e-3), 0.5e-3, 1e-12);
  EXPECT_EQ(clearance(1.0), 0.05e-3) << "the least clearance, for a wire as wide as the lumen";
}

}  // namespace
}  // namespace endovascular_sim::contact
