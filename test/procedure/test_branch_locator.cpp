#include "procedure/branch_locator.h"

#include <gtest/gtest.h>

#include "test/procedure/procedure_fixtures.h"

namespace endovascular_sim::procedure
{
namespace
{

TEST(BranchLocator, MeasuresDepthFromTheOstium)
{
  const BranchLocator locator(forkedTree());
  const BranchPosition position = locator.at({0.03, 0.001, 0.1});
  EXPECT_EQ(locator.name(position.branch), "side");
  // The lumens have radii of 10 and 3 mm, and the ostium of the side branch lies in the trunk's wall. Both walls are
  // equally distant 7 mm from the trunk's axis. Points closer to the axis belong to the trunk.
  EXPECT_NEAR(position.depth, 0.03 - 0.010, 0.0006);
  EXPECT_EQ(locator.name(locator.at({0.005, 0.0, 0.1}).branch), "trunk");
}

TEST(BranchLocator, FindsTheOstiumOfANarrowingCentrelineInTheWallOfTheParent)
{
  // In centrelines from a mesh, the maximal inscribed sphere shrinks with the distance from the trunk's axis.
  vessel::CentrelineTree tree = forkedTree();
  vessel::CentrelineBranch& side = tree.branches[1];
  side.points = {{0.0, 0.0, 0.1}, {0.012, 0.0, 0.1}, {0.05, 0.0, 0.1}};
  side.radii = {0.010, 0.003, 0.003};
  const BranchLocator locator(tree);
  EXPECT_NEAR(locator.depthIn(1, {0.03, 0.0, 0.1}), 0.03 - 0.010, 0.0006);
}

TEST(BranchLocator, PutsTheOstiumOfAnEquallyWideBranchAtItsStart)
{
  vessel::CentrelineTree tree = forkedTree();
  vessel::CentrelineBranch onwards;
  onwards.name = "onwards";
  onwards.parent = 0;
  const Eigen::Vector3d end = tree.branches[0].points.back();
  onwards.points = {end, end + Eigen::Vector3d(0.0, 0.0, 0.05)};
  onwards.radii = {0.0095, 0.009};
  tree.branches.push_back(onwards);
  EXPECT_NEAR(BranchLocator(tree).depthIn(3, end + Eigen::Vector3d(0.0, 0.0, 0.02)), 0.02, 1e-9);
}

TEST(BranchLocator, FindsThePathOverTheFork)
{
  vessel::CentrelineTree tree = forkedTree();
  const BranchLocator locator(tree);
  EXPECT_EQ(locator.pathBetween(1, 2), (std::vector<bool>{true, true, true}));
  EXPECT_EQ(locator.pathBetween(0, 2), (std::vector<bool>{true, false, true}));
  EXPECT_EQ(locator.pathBetween(2, 0), (std::vector<bool>{true, false, true}));
  EXPECT_EQ(locator.pathBetween(0, -1), (std::vector<bool>{true, true, true})) << "without a goal no branch is wrong";
}

TEST(BranchLocator, EndsThePathAtTheFork)
{
  // Two branches of the side branch. The trunk is not on the path between them.
  vessel::CentrelineTree tree = forkedTree();
  for (const double z : {0.08, 0.12})
  {
    vessel::CentrelineBranch twig;
    twig.name = z < 0.1 ? "low" : "high";
    twig.parent = 1;
    twig.points = {{0.06, 0, 0.1}, {0.08, 0, z}};
    twig.radii = {0.002, 0.002};
    tree.branches.push_back(twig);
  }
  EXPECT_EQ(BranchLocator(tree).pathBetween(3, 4), (std::vector<bool>{false, true, false, true, true}));
}

}  // namespace
}  // namespace endovascular_sim::procedure
