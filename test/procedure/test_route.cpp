#include "procedure/route.h"

#include <gtest/gtest.h>

#include <cmath>

#include "test/procedure/procedure_fixtures.h"

namespace endovascular_sim::procedure
{
namespace
{

TEST(Route, LeadsFromTheIntroducerIntoTheGoal)
{
  const BranchLocator locator(forkedTree());
  const Route route(locator, locator.find("trunk"), {0, 0, 0.001}, locator.find("goal"));
  EXPECT_NEAR(route.line().length(), 0.149 + 0.06, 1e-9);
  EXPECT_LT((route.line().at(0.12) - Eigen::Vector3d(0, 0, 0.121)).norm(), 1e-9);
  EXPECT_LT((route.line().points().back() - Eigen::Vector3d(-0.06, 0, 0.15)).norm(), 1e-9);
}

TEST(Route, AscendsToTheCommonAncestorAndDescendsFromThere)
{
  const BranchLocator locator(forkedTree());
  const Route route(locator, locator.find("side"), {0.06, 0, 0.1}, locator.find("goal"));
  EXPECT_NEAR(route.line().length(), 0.06 + 0.05 + 0.06, 1e-9);
  EXPECT_LT((route.line().at(0.06) - Eigen::Vector3d(0, 0, 0.1)).norm(), 1e-9);
  EXPECT_LT((route.line().at(0.08) - Eigen::Vector3d(0, 0, 0.12)).norm(), 1e-9);
}

TEST(Route, EndsAtTheRootOfAnAncestor)
{
  const BranchLocator locator(forkedTree());
  const Route route(locator, locator.find("goal"), {-0.05, 0, 0.15}, locator.find("trunk"));
  EXPECT_NEAR(route.line().length(), 0.05 + 0.15, 1e-9);
  EXPECT_LT(route.line().points().back().norm(), 1e-9);
}

TEST(Route, HasJunctionsWhereItTurnsOffAndWhereItPassesABranch)
{
  const BranchLocator locator(forkedTree());
  const Route route(locator, locator.find("trunk"), {0, 0, 0.001}, locator.find("goal"));
  ASSERT_EQ(route.junctions().size(), 2U);
  EXPECT_NEAR(route.junctions()[0], 0.099, 1e-9);
  EXPECT_NEAR(route.junctions()[1], 0.149, 1e-9);
  EXPECT_NEAR(route.toJunction(0.09), 0.009, 1e-9);
  EXPECT_NEAR(route.toJunction(0.105), -0.006, 1e-9);
  EXPECT_NEAR(route.toJunction(0.16), -0.011, 1e-9);
}

TEST(Route, HasNoJunctionWhereABranchContinuesAnother)
{
  vessel::CentrelineTree tree = forkedTree();
  tree.branches.resize(1);
  vessel::CentrelineBranch next = tree.branches[0];
  next.name = "next";
  next.parent = 0;
  for (Eigen::Vector3d& p : next.points)
    p.z() += 0.2;
  tree.branches.push_back(next);
  const BranchLocator locator(tree);
  const Route route(locator, 0, {0, 0, 0.001}, 1);
  EXPECT_TRUE(route.junctions().empty());
  EXPECT_TRUE(std::isinf(route.toJunction(0.1)));
}

}  // namespace
}  // namespace endovascular_sim::procedure
