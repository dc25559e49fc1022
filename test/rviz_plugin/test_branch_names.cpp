#include "rviz_plugin/picture/branch_names.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace endovascular_sim::rviz_plugin
{
namespace
{

VesselCentrelineBranch branch(const std::string& name)
{
  VesselCentrelineBranch message;
  message.name = name;
  message.points.resize(3);
  for (std::size_t k = 0; k < 3; ++k)
    message.points[k].z = 0.01 * static_cast<double>(k);
  message.radii = {2e-3, 2e-3, 2e-3};
  return message;
}

Eigen::Vector2d sizeOf(const std::string& text)
{
  return {8.0 * static_cast<double>(text.size()), 16.0};
}

TEST(BranchNames, AreThoseOfTheMessageWithBlanks)
{
  VesselCentreline message;
  message.branches = {branch("left_main")};
  const std::vector<visualization::BranchToName> branches = branchesToName(message, sizeOf);
  ASSERT_EQ(branches.size(), 1U);
  EXPECT_EQ(branches[0].text, "left main");
  EXPECT_EQ(branches[0].size, Eigen::Vector2d(72.0, 16.0));
  EXPECT_EQ(branches[0].points.size(), 3U);
  EXPECT_EQ(branches[0].radii.size(), 3U);
}

TEST(BranchNames, BranchesWithGeneratedNamesAndInvalidPointsHaveNone)
{
  VesselCentreline message;
  message.branches = {branch("branch_3"), branch(""), branch("invalid"), branch("cut")};
  message.branches[2].points[1].z = std::numeric_limits<double>::quiet_NaN();
  message.branches[3].radii.pop_back();
  const std::vector<visualization::BranchToName> branches = branchesToName(message, sizeOf);
  ASSERT_EQ(branches.size(), 4U);
  EXPECT_EQ(branches[0].text, "");
  EXPECT_EQ(branches[1].text, "");
  EXPECT_FALSE(branches[0].points.empty()) << "a branch without a name still stands in the way of names";
  EXPECT_TRUE(branches[2].points.empty());
  EXPECT_TRUE(branches[3].points.empty());
}

TEST(BranchNames, TheGoalOfTheStepComesFirst)
{
  VesselCentreline message;
  message.branches = {branch("left_main"), branch("left_circumflex"), branch("")};
  const std::vector<visualization::BranchToName> branches = branchesToName(message, sizeOf, "left_circumflex");
  EXPECT_FALSE(branches[0].comes_first);
  EXPECT_TRUE(branches[1].comes_first);
  for (const visualization::BranchToName& branch : branchesToName(message, sizeOf))
    EXPECT_FALSE(branch.comes_first) << "no goal";
}

TEST(BranchNames, ReachToTheSurroundingsOfATipInThePicture)
{
  visualization::PictureView view;
  view.eye = {0.0, -0.1, 0.0};
  EXPECT_NEAR(reachOfNames({0.0, 0.0, 0.0}, view), 0.15, 1e-9);
  EXPECT_TRUE(std::isinf(reachOfNames({5.0, 0.0, 0.0}, view))) << "outside of the picture";
  EXPECT_TRUE(std::isinf(reachOfNames({0.0, -1.0, 0.0}, view))) << "behind the eye";
  EXPECT_TRUE(std::isinf(reachOfNames({std::nan(""), 0.0, 0.0}, view)));
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
