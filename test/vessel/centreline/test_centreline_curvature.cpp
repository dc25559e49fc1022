#include "vessel/centreline/centreline_curvature.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::vessel
{
namespace
{

/** Straight segment of 50 mm along x, then a quarter circle of 30 mm radius, with points perturbed by 1 µm. */
CentrelineTree bentCentreline()
{
  CentrelineBranch branch;
  for (int i = 0; i <= 500; ++i)
  {
    const double s = 0.2e-3 * i;
    const double turn = std::max(0.0, s - 0.05) / 0.03;
    branch.points.emplace_back(std::min(s, 0.05) + 0.03 * std::sin(turn), 0.03 * (1.0 - std::cos(turn)),
                               i % 2 == 0 ? 1e-6 : -1e-6);
    branch.radii.push_back(3e-3);
  }
  CentrelineTree tree;
  tree.branches = {branch};
  return tree;
}

TEST(CentrelineCurvature, EqualsThatOfTheNearestPointOfTheCentreline)
{
  const CentrelineCurvature curvature(bentCentreline());
  EXPECT_NEAR(curvature.at({0.020, 2e-3, 0.0}), 0.0, 0.5);
  const double turn = 0.8;
  EXPECT_NEAR(curvature.at({0.05 + 0.032 * std::sin(turn), 0.03 - 0.032 * std::cos(turn), 1e-3}), 1.0 / 0.03, 0.5);
}

TEST(CentrelineCurvature, IsZeroWithoutACentreline)
{
  EXPECT_EQ(CentrelineCurvature(CentrelineTree()).at({0.0, 0.0, 0.0}), 0.0);
}

}  // namespace
}  // namespace endovascular_sim::vessel
