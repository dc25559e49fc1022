#include "flow/coupling/tree_path.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::flow
{
namespace
{

/** Trunk of 100 mm along x, with a branch of 50 mm along y at 40 mm and one of 30 mm along −y at 70 mm. */
vessel::CentrelineTree fork()
{
  vessel::CentrelineTree tree;
  tree.branches.push_back(
      {"trunk", -1, {{0.0, 0.0, 0.0}, {0.04, 0.0, 0.0}, {0.07, 0.0, 0.0}, {0.1, 0.0, 0.0}}, {5e-3, 5e-3, 5e-3, 5e-3}});
  tree.branches.push_back({"left", 0, {{0.04, 0.0, 0.0}, {0.04, 0.05, 0.0}}, {2e-3, 2e-3}});
  tree.branches.push_back({"right", 0, {{0.07, 0.0, 0.0}, {0.07, -0.03, 0.0}}, {2e-3, 2e-3}});
  return tree;
}

TEST(TreePath, LeadsOverTheCommonAncestorAndMeasuresItsLength)
{
  const TreePaths paths(fork());
  const TreePath path = paths.between({1, 0.02}, {2, 0.01});
  EXPECT_NEAR(path.length(), 0.02 + 0.03 + 0.01, 1e-12);
  EXPECT_EQ(path.at(0.01).branch, 1);
  EXPECT_NEAR(path.at(0.01).arc, 0.01, 1e-12);
  EXPECT_EQ(path.at(0.03).branch, 0);
  EXPECT_NEAR(path.at(0.03).arc, 0.05, 1e-12);
  EXPECT_EQ(path.at(0.055).branch, 2);
  EXPECT_NEAR(path.at(0.055).arc, 0.005, 1e-12);
  EXPECT_NEAR(path.at(1.0).arc, 0.01, 1e-12) << "beyond its end";
}

TEST(TreePath, IsTheSameInBothDirections)
{
  const TreePaths paths(fork());
  const TreePath there = paths.between({1, 0.03}, {0, 0.09}), back = paths.between({0, 0.09}, {1, 0.03});
  ASSERT_NEAR(there.length(), back.length(), 1e-12);
  for (const double distance : {0.0, 0.02, 0.035, 0.06, 0.08})
  {
    const TreePlace a = there.at(distance), b = back.at(there.length() - distance);
    EXPECT_EQ(a.branch, b.branch);
    EXPECT_NEAR(a.arc, b.arc, 1e-12);
  }
}

TEST(TreePath, GivesTheSpansOfAnInstrumentOnEachBranch)
{
  const TreePaths paths(fork());
  std::vector<InstrumentSpan> spans;
  paths.between({1, 0.02}, {0, 0.0}).addSpans(0.005, 0.045, 1e-3, spans);
  ASSERT_EQ(spans.size(), 2U);
  EXPECT_EQ(spans[0].branch, 1);
  EXPECT_NEAR(spans[0].begin, 0.0, 1e-12);
  EXPECT_NEAR(spans[0].end, 0.015, 1e-12);
  EXPECT_EQ(spans[1].branch, 0);
  EXPECT_NEAR(spans[1].begin, 0.015, 1e-12);
  EXPECT_NEAR(spans[1].end, 0.04, 1e-12);
}

TEST(TreePath, IsEmptyOutsideTheVessel)
{
  const TreePaths paths(fork());
  const TreePath path = paths.between({-1, 0.0}, {0, 0.05});
  EXPECT_EQ(path.length(), 0.0);
  EXPECT_EQ(path.at(0.0).branch, -1);
}

TEST(TreePaths, LocateAPointInTheNearestLumen)
{
  const TreePaths paths(fork());
  const TreePlace place = paths.locate({0.0405, 0.02, 0.0});
  EXPECT_EQ(place.branch, 1);
  EXPECT_NEAR(place.arc, 0.02, 1e-9);
  EXPECT_NEAR(paths.tangentAt(place).y(), 1.0, 1e-9);
  EXPECT_EQ(paths.locate({0.04, 0.003, 0.0}).branch, 0) << "within the trunk's lumen";
}

TEST(TreePaths, LocateAPointNearAnotherOneAsWithoutIt)
{
  const TreePaths paths(fork());
  for (const Eigen::Vector3d& point : {Eigen::Vector3d(0.0405, 0.02, 0.0), Eigen::Vector3d(0.02, 0.001, 0.001),
                                       Eigen::Vector3d(0.07, -0.02, 0.0005), Eigen::Vector3d(0.09, 0.0, 0.004)})
    for (int near = -1; near < 3; ++near)
    {
      const TreePlace alone = paths.locate(point), found = paths.locate(point, {near, 0.01});
      EXPECT_EQ(found.branch, alone.branch) << point.transpose() << " near " << near;
      EXPECT_NEAR(found.arc, alone.arc, 1e-12);
    }
}

}  // namespace
}  // namespace endovascular_sim::flow
