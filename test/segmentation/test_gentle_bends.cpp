#include "segmentation/gentle_bends.h"

#include <cmath>

#include <gtest/gtest.h>

#include "test/segmentation/written_centreline.h"

namespace endovascular_sim::segmentation
{
namespace
{

/** Arc of a circle in a plane. */
vessel::CentrelineBranch arc(double bend_radius, double lumen_radius, double angle, int points)
{
  vessel::CentrelineBranch branch;
  branch.name = "arc";
  for (int k = 0; k < points; ++k)
  {
    const double a = angle * k / (points - 1);
    branch.points.emplace_back(bend_radius * std::cos(a), bend_radius * std::sin(a), 0.0);
    branch.radii.push_back(lumen_radius);
  }
  return branch;
}

TEST(GentleBends, RatioOfAnArcIsThatOfItsRadii)
{
  // A natural spline overshoots at its ends, so a sample there bends by up to 27 % more.
  const double exact = 0.02 / (vessel::kTightestBend * 0.004);
  EXPECT_GT(bendRatio(arc(0.02, 0.004, 2.0, 20)), exact / 1.27);
  EXPECT_LT(bendRatio(arc(0.02, 0.004, 2.0, 20)), exact);
}

TEST(GentleBends, LeaveAGentleBranchUnchanged)
{
  vessel::CentrelineBranch branch = arc(0.02, 0.004, 2.0, 20);
  const vessel::CentrelineBranch before = branch;
  makeBendsGentle(branch);
  EXPECT_EQ(branch.points, before.points);
  EXPECT_EQ(branch.radii, before.radii);
}

TEST(GentleBends, LetAnAnatomyAcceptAHairpin)
{
  vessel::CentrelineBranch hairpin = arc(0.004, 0.004, M_PI, 6);
  for (int k = 1; k <= 5; ++k)
  {
    hairpin.points.emplace_back(-0.004, -0.004 * k, 0.0);
    hairpin.points.insert(hairpin.points.begin(), Eigen::Vector3d(0.004, -0.004 * k, 0.0));
    hairpin.radii.resize(hairpin.points.size(), 0.004);
  }
  vessel::CentrelineTree tree;
  tree.branches = {hairpin};
  EXPECT_ANY_THROW(writtenChains(tree));
  makeBendsGentle(tree.branches[0]);
  EXPECT_NO_THROW(writtenChains(tree));
  EXPECT_EQ(tree.branches[0].points.front(), hairpin.points.front());
  EXPECT_EQ(tree.branches[0].points.back(), hairpin.points.back());
}

}  // namespace
}  // namespace endovascular_sim::segmentation
