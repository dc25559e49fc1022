#include "intervention/vessel_dilatation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "test/intervention/treated_tube.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::intervention
{
namespace
{

constexpr double kHalf = 5.0 * kAtmosphere;  // pressure at a yield fraction of one half
constexpr double kFull = 8.0 * kAtmosphere;

/** Cylinder on the tube's axis. */
RoundBody cylinder(double radius, double begin = 0.022, double end = 0.038, double aside = 0.0, int segments = 32)
{
  RoundBody body;
  for (int k = 0; k <= segments; ++k)
  {
    body.axis.emplace_back(aside, 0.0, begin + (end - begin) * k / segments);
    body.radii.push_back(radius);
  }
  return body;
}

TEST(VesselDilatation, ReachesTheBalloonDiameterAtFullPressure)
{
  VesselDilatation opening(tubeWithLesion(0.7), DilatationLaw{});
  opening.applyLoad(cylinder(1.5e-3), kFull);
  EXPECT_GE(wallBetween(opening.mesh(), 0.023, 0.037).first, 1.5e-3 - 2e-6);
  EXPECT_LE(wallBetween(opening.mesh(), 0.023, 0.037).second, 1.5e-3 + 2e-6);
  const vessel::MeshReport report = vessel::checkMesh(opening.mesh());
  EXPECT_TRUE(report.clean()) << report.summary();
  EXPECT_FALSE(opening.atRisk());
}

TEST(VesselDilatation, FollowsTheLawBelowFullPressure)
{
  const vessel::Vessel vessel = tubeWithLesion(0.7);
  const double narrowed = wallBetween(vessel.mesh, 0.025, 0.035).first;
  EXPECT_NEAR(narrowed, 0.45e-3, 0.01e-3);
  VesselDilatation opening(vessel, DilatationLaw{});
  opening.applyLoad(cylinder(1.4e-3), 1.9 * kAtmosphere);
  EXPECT_EQ(wallBetween(opening.mesh(), 0.025, 0.035).first, narrowed);
  opening.applyLoad(cylinder(1.4e-3), kHalf);
  EXPECT_NEAR(wallBetween(opening.mesh(), 0.025, 0.035).first, narrowed + 0.5 * (1.4e-3 - narrowed), 2e-6);
}

TEST(VesselDilatation, RecoilsByItsFractionOfTheDiameter)
{
  for (double recoil : {0.1, 0.25})
  {
    DilatationLaw law;
    law.recoil = recoil;
    VesselDilatation opening(tubeWithLesion(0.7), law);
    opening.applyLoad(cylinder(1.5e-3), kFull);
    opening.applyLoad(cylinder(0.45e-3), 0.5 * kAtmosphere);
    EXPECT_NEAR(wallBetween(opening.mesh(), 0.029, 0.031).first, (1.0 - recoil) * 1.5e-3, 2e-6);
    opening.applyLoad(cylinder(0.45e-3), 0.0);
    EXPECT_NEAR(wallBetween(opening.mesh(), 0.029, 0.031).first, (1.0 - recoil) * 1.5e-3, 2e-6);
    EXPECT_NEAR(wallBetween(opening.mesh(), 0.005, 0.02).first, kTubeRadius, 1e-9) << "the healthy wall is unchanged";
  }
}

TEST(VesselDilatation, IsIndependentOfTheNumberOfCalls)
{
  const vessel::Vessel vessel = tubeWithLesion(0.7);
  VesselDilatation once(vessel, DilatationLaw{});
  once.applyLoad(cylinder(1.5e-3), kFull);
  VesselDilatation often(vessel, DilatationLaw{});
  geometry::TriangleMesh followed = vessel.mesh;
  for (int k = 1; k <= 100; ++k)
  {
    const WallDisplacement& moved = often.applyLoad(cylinder(0.015e-3 * k), 0.01 * k * kFull);
    for (std::size_t i = 0; i < moved.indices.size(); ++i)
      followed.vertices[static_cast<std::size_t>(moved.indices[i])] = moved.positions[i];
  }
  for (std::size_t v = 0; v < vessel.mesh.vertices.size(); ++v)
  {
    EXPECT_LT((once.mesh().vertices[v] - often.mesh().vertices[v]).norm(), 2e-6);
    EXPECT_EQ(followed.vertices[v], often.mesh().vertices[v]) << "all displacements were returned";
  }
  EXPECT_TRUE(often.applyLoad(cylinder(1.5e-3), kFull).indices.empty()) << "no vertex moves twice";
}

// Between searches the surroundings of a balloon are followed. A change of the number of its points forces a search.
TEST(VesselDilatation, FollowsTheSurroundingsOfABalloonThatMovesAndGrowsAsSearchesWouldFindThem)
{
  const vessel::Vessel vessel = tubeWithLesion(0.7);
  VesselDilatation following(vessel, DilatationLaw{});
  VesselDilatation searching(vessel, DilatationLaw{});
  for (int k = 0; k <= 100; ++k)
  {
    const double begin = 0.022 + 4e-5 * k;
    const double radius = 0.4e-3 + 1.2e-5 * k;
    following.applyLoad(cylinder(radius, begin, begin + 0.012, 1e-6 * k), kFull);
    searching.applyLoad(cylinder(radius, begin, begin + 0.012, 1e-6 * k, 32 + k % 2), kFull);
  }
  EXPECT_GT(wallBetween(following.mesh(), 0.029, 0.031).first, 1.4e-3);
  for (std::size_t v = 0; v < vessel.mesh.vertices.size(); ++v)
    ASSERT_LT((following.mesh().vertices[v] - searching.mesh().vertices[v]).norm(), 1e-8) << v;
}

TEST(VesselDilatation, LimitsTheMovedVerticesPerCall)
{
  const vessel::Vessel vessel = tubeWithLesion(0.7);
  VesselDilatation once(vessel, DilatationLaw{});
  const std::size_t all = once.applyLoad(cylinder(1.5e-3), kFull).indices.size();
  once.applyLoad(cylinder(0.0), 0.0);
  VesselDilatation slowly(vessel, DilatationLaw{});
  std::size_t calls = 0;
  for (std::size_t moved = 1; moved > 0; ++calls)
  {
    moved = slowly.applyLoad(cylinder(1.5e-3), kFull, 100).indices.size();
    EXPECT_LE(moved, 100U);
  }
  EXPECT_EQ(calls, (all + 99) / 100 + 1);
  while (!slowly.applyLoad(cylinder(0.0), 0.0, 100).indices.empty())
  {
  }
  for (std::size_t v = 0; v < vessel.mesh.vertices.size(); ++v)
    EXPECT_LT((once.mesh().vertices[v] - slowly.mesh().vertices[v]).norm(), 1e-9);
}

TEST(VesselDilatation, StartsFromTheResultOfThePreviousBalloon)
{
  VesselDilatation opening(tubeWithLesion(0.7), DilatationLaw{});
  opening.applyLoad(cylinder(1.2e-3), kFull);
  opening.applyLoad(cylinder(0.0), 0.0);
  const double left = wallBetween(opening.mesh(), 0.029, 0.031).first;
  EXPECT_NEAR(left, 0.9 * 1.2e-3, 2e-6);
  opening.applyLoad(cylinder(1.6e-3), kHalf);
  EXPECT_NEAR(wallBetween(opening.mesh(), 0.029, 0.031).first, left + 0.5 * (1.6e-3 - left), 4e-6);
}

TEST(VesselDilatation, ReportsTheStretchRelativeToTheHealthyVessel)
{
  VesselDilatation opening(tubeWithLesion(0.5, 1.1e-3), DilatationLaw{});
  opening.applyLoad(cylinder(1.32e-3), kFull);
  EXPECT_NEAR(opening.largestStretch(), 1.2, 0.01);
  EXPECT_FALSE(opening.atRisk());
  opening.applyLoad(cylinder(1.6e-3), kFull);
  EXPECT_NEAR(opening.largestStretch(), 1.6 / 1.1, 0.01);
  EXPECT_TRUE(opening.atRisk());
}

TEST(VesselDilatation, DoesNotAffectAnAdjacentVessel)
{
  vessel::Vessel vessel = tubeWithLesion(0.0);
  const std::size_t own = vessel.mesh.vertices.size();
  const Eigen::Vector3d beside(3.1e-3, 0.0,
                               0.0);  // axis of the adjacent vessel, whose near wall is 1.6 mm from the balloon's axis
  for (std::size_t v = 0; v < own; ++v)
    vessel.mesh.vertices.emplace_back(vessel.mesh.vertices[v] + beside);
  const std::size_t triangles = vessel.mesh.triangles.size();
  for (std::size_t t = 0; t < triangles; ++t)
    vessel.mesh.triangles.emplace_back(vessel.mesh.triangles[t] + Eigen::Vector3i::Constant(static_cast<int>(own)));
  VesselDilatation opening(vessel, DilatationLaw{});
  for (int v : opening.applyLoad(cylinder(1.8e-3), kFull).indices)
    EXPECT_LT(v, static_cast<int>(own));
  EXPECT_NEAR(wallBetween(vessel.mesh, 0.03, 0.031).first, 1.5e-3, 1e-5);
}

TEST(VesselDilatation, KeepsTheWallOutsideASleeve)
{
  VesselDilatation opening(tubeWithLesion(0.7), DilatationLaw{});
  opening.applyLoad(cylinder(1.5e-3), kFull);
  opening.placeSleeve(cylinder(1.45e-3, 0.028, 0.032));
  opening.applyLoad(cylinder(0.0), 0.0);
  EXPECT_NEAR(wallBetween(opening.mesh(), 0.0285, 0.0315).first, 1.45e-3, 2e-6);
  EXPECT_LT(wallBetween(opening.mesh(), 0.0325, 0.0335).first, 1.36e-3) << "recoil beside the sleeve";
}

}  // namespace
}  // namespace endovascular_sim::intervention
