#include "vessel/centreline/branch_finder.h"

#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace endovascular_sim::vessel
{
namespace
{

/** Wide trunk along z, and a narrow lateral branch that begins on the trunk's centreline at half height. */
CentrelineTree trunkWithBranch()
{
  CentrelineTree tree;
  tree.branches.resize(2);
  for (int k = 0; k <= 20; ++k)
    tree.branches[0].points.emplace_back(0.0, 0.0, 5e-3 * k);
  tree.branches[0].radii.assign(21, 10e-3);
  for (int k = 0; k <= 20; ++k)
    tree.branches[1].points.emplace_back(2e-3 * k, 0.0, 50e-3);
  tree.branches[1].radii.assign(21, 1.5e-3);
  tree.branches[1].parent = 0;
  return tree;
}

TEST(BranchFinder, AssignsTheWallBesideAnOstiumToTheParent)
{
  const BranchFinder finder(trunkWithBranch());
  EXPECT_EQ(finder.nearest({10e-3, 0.0, 54e-3}), 0);  // 4 mm beside the ostium, 10 mm from the trunk's centreline
  EXPECT_EQ(finder.nearest({9e-3, 4.36e-3, 50e-3}), 0);
  EXPECT_EQ(finder.nearest({20e-3, 1.5e-3, 50e-3}), 1);
  EXPECT_EQ(finder.nearest({-10e-3, 0.0, 50e-3}), 0);  // opposite the ostium
  EXPECT_EQ(finder.nearest({0.0, 0.0, 200e-3}), 0);    // beyond the trunk's end
}

TEST(BranchFinder, EqualsABruteForceSearch)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-0.1, 0.1);
  std::uniform_real_distribution<double> width(1e-3, 12e-3);
  CentrelineTree tree;
  for (int b = 0; b < 12; ++b)
  {
    CentrelineBranch branch;
    Eigen::Vector3d point(place(random), place(random), place(random));
    for (int k = 0; k < 15; ++k)
    {
      branch.points.push_back(point);
      branch.radii.push_back(width(random));
      point += 0.1 * Eigen::Vector3d(place(random), place(random), place(random));
    }
    tree.branches.push_back(branch);
  }
  const BranchFinder finder(tree);
  for (int trial = 0; trial < 500; ++trial)
  {
    const Eigen::Vector3d point(place(random), place(random), place(random));
    int nearest = -1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t b = 0; b < tree.branches.size(); ++b)
      for (std::size_t k = 0; k + 1 < tree.branches[b].points.size(); ++k)
      {
        const Eigen::Vector3d from = tree.branches[b].points[k];
        const Eigen::Vector3d along = tree.branches[b].points[k + 1] - from;
        const double t = std::min(1.0, std::max(0.0, along.dot(point - from) / along.dot(along)));
        const double radius = (1.0 - t) * tree.branches[b].radii[k] + t * tree.branches[b].radii[k + 1];
        const double distance = (from + t * along - point).norm() - radius;
        if (distance < least - 1e-15)
        {
          least = distance;
          nearest = static_cast<int>(b);
        }
      }
    EXPECT_EQ(finder.nearest(point), nearest) << trial;
  }
}

TEST(BranchFinder, ReturnsNoBranchWithoutACentreline)
{
  EXPECT_EQ(BranchFinder(CentrelineTree()).nearest({1.0, 2.0, 3.0}), -1);
  CentrelineTree tree;
  tree.branches.resize(2);
  tree.branches[1].points.emplace_back(0.0, 0.0, 0.0);
  tree.branches[1].radii.push_back(1e-3);
  EXPECT_EQ(BranchFinder(tree).nearest({1.0, 2.0, 3.0}), 1);  // a branch may consist of one point
}

TEST(BranchFinder, ReturnsNoBranchForAPointThatIsNotFinite)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const BranchFinder finder(trunkWithBranch());
  EXPECT_EQ(finder.nearest({nan, 0.0, 0.0}), -1);
  EXPECT_EQ(finder.nameAt({nan, nan, nan}), "");
  EXPECT_EQ(finder.nearest({0.0, std::numeric_limits<double>::infinity(), 0.0}), -1);
}

}  // namespace
}  // namespace endovascular_sim::vessel
