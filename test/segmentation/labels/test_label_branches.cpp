#include "segmentation/labels/label_branches.h"

#include <gtest/gtest.h>

namespace endovascular_sim::segmentation
{
namespace
{

/** Straight branch with a point every millimetre. */
vessel::CentrelineBranch branch(int parent, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius)
{
  vessel::CentrelineBranch result;
  result.parent = parent;
  const int n = static_cast<int>(std::lround((to - from).norm() / 1e-3));
  for (int k = 0; k <= n; ++k)
  {
    result.points.emplace_back(from + static_cast<double>(k) / n * (to - from));
    result.radii.push_back(radius);
  }
  return result;
}

/** Trunk along z that ends at a fork, its continuation, and a side branch along x. */
vessel::CentrelineTree fork()
{
  vessel::CentrelineTree tree;
  tree.branches.push_back(branch(-1, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.05}, 0.005));
  tree.branches.push_back(branch(0, {0.0, 0.0, 0.05}, {0.03, 0.0, 0.05}, 0.003));
  tree.branches.push_back(branch(0, {0.0, 0.0, 0.05}, {0.0, 0.0, 0.1}, 0.004));
  return tree;
}

TEST(LabelBranches, OfOneLabelAreNumbered)
{
  const vessel::CentrelineTree tree = namedByLabels(fork(), [](const Eigen::Vector3d&) { return 0; }, {"aorta"});
  ASSERT_EQ(tree.branches.size(), 2U);
  EXPECT_EQ(tree.branches[0].name, "aorta");
  EXPECT_EQ(tree.branches[1].name, "aorta_2");
  EXPECT_EQ(tree.branches[1].parent, 0);
  EXPECT_NEAR(tree.branches[0].points.back().z(), 0.1, 1e-12);
  EXPECT_EQ(tree.branches[0].points.size(), 101U);
}

TEST(LabelBranches, HaveTheNameOfTheLabelBeyondTheLumenOfTheirParent)
{
  const auto labelAt = [](const Eigen::Vector3d& p) { return p.x() > 0.005 ? 1 : 0; };
  const vessel::CentrelineTree tree = namedByLabels(fork(), labelAt, {"aorta", "renal_artery"});
  ASSERT_EQ(tree.branches.size(), 2U);
  EXPECT_EQ(tree.branches[0].name, "aorta");
  EXPECT_EQ(tree.branches[1].name, "renal_artery");
  EXPECT_EQ(tree.branches[1].points.front(), Eigen::Vector3d(0.0, 0.0, 0.05));
}

TEST(LabelBranches, BeginWhereTheLabelChangesAlongOneVessel)
{
  vessel::CentrelineTree one;
  one.branches.push_back(branch(-1, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.1}, 0.003));
  // A short stretch of another label, one without a label, and a long one.
  const auto labelAt = [](const Eigen::Vector3d& p)
  {
    const double z = p.z();
    return z > 0.02 && z < 0.024 ? 1 : z > 0.03 && z < 0.034 ? -1 : z > 0.06 ? 1 : 0;
  };
  const vessel::CentrelineTree tree = namedByLabels(one, labelAt, {"aorta", "iliac"});
  ASSERT_EQ(tree.branches.size(), 2U);
  EXPECT_EQ(tree.branches[1].name, "iliac");
  EXPECT_EQ(tree.branches[1].parent, 0);
  EXPECT_NEAR(tree.branches[0].points.back().z(), 0.061, 1.1e-3);
  EXPECT_EQ(tree.branches[0].points.back(), tree.branches[1].points.front());
}

}  // namespace
}  // namespace endovascular_sim::segmentation
