#include "motion/body/heart_placement.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "test/common/input_error_of.h"
#include "test/motion/motion_fixtures.h"

namespace endovascular_sim::motion
{
namespace
{

using Eigen::Vector3d;

std::string errorOf(const vessel::CentrelineTree& tree, const MotionRegion& region)
{
  return inputErrorOf([&] { placeHeart(tree, region, {"scene.yaml", "motion.patient."}); });
}

/** Largest displacement of the points of a branch [m]. */
double excursion(const MotionMap& map, const std::string& name)
{
  double largest = 0.0;
  for (const Vector3d& point : branchNamed(naturalCentreline(), name).points)
    largest = std::max(largest, map.displacement(point).norm());
  return largest;
}

TEST(HeartOfTheNaturalAnatomy, HasItsAxisFromTheOstiaToTheEndOfTheLad)
{
  const HeartFrame heart = naturalHeart();
  EXPECT_EQ(heart.apex(), heart.base + heart.length * heart.axis);
  EXPECT_LT((heart.apex() - branchNamed(naturalCentreline(), "left_anterior_descending").points.back()).norm(), 1e-12);
  EXPECT_GT(heart.length, 0.09);
  EXPECT_LT(heart.length, 0.14);
  EXPECT_GT(heart.axis.x(), 0.3);   // to the left,
  EXPECT_LT(heart.axis.y(), -0.3);  // anterior,
  EXPECT_LT(heart.axis.z(), -0.3);  // and caudal
  EXPECT_NEAR(heart.fade.width(), 0.05, 1e-15);
}

TEST(HeartOfTheNaturalAnatomy, MovesItsCoronaryArteriesByFiveToFifteenMillimetresWithABeat)
{
  const MotionMap map = mapAt(endSystole(), 0.0);
  for (const char* name : {"left_main", "left_anterior_descending", "left_circumflex", "right_coronary"})
  {
    EXPECT_GT(excursion(map, name), 5e-3) << name;
    EXPECT_LT(excursion(map, name), 15e-3) << name;
  }
  EXPECT_GT(excursion(map, "right_coronary"), excursion(map, "left_anterior_descending"));  // Mao et al. 2000
}

TEST(HeartOfTheNaturalAnatomy, DoesNotMoveTheWallOfTheAortaBeyondTheHeart)
{
  for (int phase = 0; phase < 20; ++phase)
  {
    const MotionMap map = mapAt(0.05 * phase, endInspiration());
    for (const char* name : {"aortic_arch", "descending_aorta", "abdominal_aorta"})
    {
      const vessel::CentrelineBranch& branch = branchNamed(naturalCentreline(), name);
      for (std::size_t k = 0; k < branch.points.size(); ++k)
      {
        const Vector3d towards = (map.frame().fade.centre - branch.points[k]).normalized();
        EXPECT_LT(map.displacement(branch.points[k] + branch.radii[k] * towards).norm(), 1e-9) << name;
      }
    }
  }
}

TEST(HeartOfTheNaturalAnatomy, MovesItsCoronaryArteriesAtPublishedSpeeds)
{
  // Mao et al. 2000: 22 to 109 mm/s, for parts of the arteries and of the beat.
  double fastest = 0.0;
  for (int phase = 0; phase < 50; ++phase)
  {
    const MotionMap map = mapAt(0.02 * phase, 0.0);
    for (const char* name : {"left_main", "left_anterior_descending", "left_circumflex", "right_coronary"})
      for (const Vector3d& point : branchNamed(naturalCentreline(), name).points)
        fastest = std::max(fastest, map.velocity(point).norm());
  }
  EXPECT_GT(fastest, 0.022);
  EXPECT_LT(fastest, 0.109);
}

TEST(PlaceOfTheHeart, TurnsWithTheVessel)
{
  const Eigen::Isometry3d pose =
      Eigen::Translation3d(0.1, -0.2, 0.3) * Eigen::AngleAxisd(1.1, Vector3d(1, 2, -2).normalized());
  vessel::CentrelineTree tree = naturalCentreline();
  for (vessel::CentrelineBranch& branch : tree.branches)
    for (Vector3d& point : branch.points)
      point = pose * point;
  const HeartFrame heart = naturalHeart(), turned = placeHeart(tree, adultMotion().region, {"scene.yaml", ""});
  EXPECT_LT((turned.base - pose * heart.base).norm(), 1e-12);
  EXPECT_LT((turned.apex() - pose * heart.apex()).norm(), 1e-12);
  EXPECT_LT((turned.fade.centre - pose * heart.fade.centre).norm(), 1e-9);
  EXPECT_NEAR(turned.fade.core, heart.fade.core, 1e-9);
}

TEST(PlaceOfTheHeart, IsThatOfTheKeysWhereTheyAreGiven)
{
  MotionRegion region = adultMotion().region;
  region.base = Vector3d(0.01, -0.02, 0.18);
  region.apex = Vector3d(0.07, -0.07, 0.12);
  region.centre = Vector3d(0.03, -0.08, 0.15);
  region.core = 0.03;
  const HeartFrame heart = placeHeart(naturalCentreline(), region, {"scene.yaml", ""});
  EXPECT_EQ(heart.base, *region.base);
  EXPECT_LT((heart.apex() - *region.apex).norm(), 1e-15);
  EXPECT_EQ(heart.fade.centre, *region.centre);
  EXPECT_EQ(heart.fade.reach, region.core + region.fade);
}

TEST(PlaceOfTheHeart, IsRefusedInAVesselWithoutBranchesOfTheNames)
{
  vessel::CentrelineTree unnamed = naturalCentreline();
  for (std::size_t k = 0; k < unnamed.branches.size(); ++k)
    unnamed.branches[k].name = "branch_" + std::to_string(k);
  EXPECT_NE(
      errorOf(unnamed, adultMotion().region)
          .find("scene.yaml: motion.patient.region.left_ostium: the vessel has no branch \"left_main\"; its branches "
                "are"),
      std::string::npos)
      << errorOf(unnamed, adultMotion().region);
  MotionRegion region = adultMotion().region;
  region.fixed.back() = "abdominal_aota";
  EXPECT_NE(
      errorOf(naturalCentreline(), region)
          .find(
              "region.fixed.2.branch: the vessel has no branch \"abdominal_aota\"; did you mean \"abdominal_aorta\"?"),
      std::string::npos)
      << errorOf(naturalCentreline(), region);
}

TEST(PlaceOfTheHeart, IsRefusedWithoutRoomForTheFade)
{
  MotionRegion region = adultMotion().region;
  region.fade = 0.3;
  EXPECT_NE(errorOf(naturalCentreline(), region).find("region.fade: there is no room for a fade of 300 mm"),
            std::string::npos)
      << errorOf(naturalCentreline(), region);
  region = adultMotion().region;
  region.centre = naturalHeart().fade.centre;
  region.core = 0.1;
  EXPECT_NE(errorOf(naturalCentreline(), region).find("region.core: the fade around region.centre reaches a branch"),
            std::string::npos);
  region = adultMotion().region;
  region.apex_branch = "ascending_aorta";
  region.base = branchNamed(naturalCentreline(), "left_main").points.front();
  region.apex = *region.base + Vector3d(0.0, 0.0, 0.001);
  EXPECT_NE(errorOf(naturalCentreline(), region).find("region.apex_branch: its end is 1 mm from the ostia"),
            std::string::npos)
      << errorOf(naturalCentreline(), region);
}

}  // namespace
}  // namespace endovascular_sim::motion
