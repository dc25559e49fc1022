#include "rviz_plugin/model/branch_names.h"

#include <limits>

#include <gtest/gtest.h>

namespace endovascular_sim::rviz_plugin
{
namespace
{

/** View from the front over the origin; a metre there has 800 pixels. */
PictureView viewFromTheFront()
{
  PictureView view;
  view.eye = {0.0, -1.0, 0.0};
  return view;
}

VesselCentrelineBranch branch(const std::string& name, const Eigen::Vector3d& begin, const Eigen::Vector3d& end)
{
  VesselCentrelineBranch message;
  message.name = name;
  for (int k = 0; k <= 50; ++k)
  {
    const Eigen::Vector3d at = begin + k / 50.0 * (end - begin);
    geometry_msgs::Point point;
    point.x = at.x();
    point.y = at.y();
    point.z = at.z();
    message.points.push_back(point);
    message.radii.push_back(4e-3);
  }
  return message;
}

/** An iliac fork: its branches are closer than their names are wide. */
VesselCentreline fork()
{
  VesselCentreline message;
  message.branches = {branch("abdominal_aorta", {0, 0, 0.2}, {0, 0, 0}),
                      branch("right_common_iliac", {0, 0, 0}, {-0.03, 0, -0.06}),
                      branch("left_common_iliac", {0, 0, 0}, {0.03, 0, -0.06}),
                      branch("right_external_iliac", {-0.03, 0, -0.06}, {-0.05, 0, -0.12}),
                      branch("left_external_iliac", {0.03, 0, -0.06}, {0.05, 0, -0.12}),
                      branch("right_internal_iliac", {-0.03, 0, -0.06}, {-0.025, 0.02, -0.1}),
                      branch("left_internal_iliac", {0.03, 0, -0.06}, {0.025, 0.02, -0.1})};
  return message;
}

TEST(BranchNames, StandBesideTheirBranch)
{
  const std::vector<BranchName> names = branchNames(fork(), viewFromTheFront(), 13.0);
  ASSERT_EQ(names.front().text, "abdominal aorta");  // the longest
  const Eigen::Vector2d place = viewFromTheFront().project(names.front().position);
  EXPECT_GT(std::abs(place.x()), 0.004 * 800.0);
  EXPECT_GT(names.front().position.z(), 0.0);
  EXPECT_NEAR(names.front().height, 13.0 / 800.0, 1e-6);
}

TEST(BranchNames, DoNotOverlapAtAFork)
{
  const PictureView view = viewFromTheFront();
  const std::vector<BranchName> names = branchNames(fork(), view, 13.0);
  EXPECT_EQ(names.size(), 7U);
  for (std::size_t a = 0; a < names.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
    {
      const Eigen::Vector2d first = view.project(names[a].position), second = view.project(names[b].position);
      const double gap_right = second.x() - first.x() - 13.0 * 0.4 * static_cast<double>(names[a].text.size());
      const double gap_left = first.x() - second.x() - 13.0 * 0.4 * static_cast<double>(names[b].text.size());
      EXPECT_TRUE(std::abs(first.y() - second.y()) >= 12.9 || gap_right > 0.0 || gap_left > 0.0)
          << names[a].text << ", " << names[b].text;
    }
}

TEST(BranchNames, StayInThePicture)
{
  PictureView view = viewFromTheFront();
  view.width = 300.0;
  view.height = 200.0;
  for (const BranchName& name : branchNames(fork(), view, 13.0))
  {
    const Eigen::Vector2d place = view.project(name.position);
    EXPECT_GT(place.x(), -150.0);
    EXPECT_LT(place.x() + 13.0 * 0.4 * static_cast<double>(name.text.size()), 150.0);
    EXPECT_LT(std::abs(place.y()), 100.0);
  }
}

TEST(BranchNames, AvoidTheLegendsAtTheLowerLeft)
{
  PictureView view = viewFromTheFront();
  const std::size_t all = branchNames(fork(), view, 13.0).size();
  view.legend_width = view.width;
  view.legend_height = 0.5 * view.height;
  const std::vector<BranchName> names = branchNames(fork(), view, 13.0);
  EXPECT_LT(names.size(), all);
  EXPECT_FALSE(names.empty());
  for (const BranchName& name : names)
    EXPECT_GT(view.project(name.position).y(), 0.0) << name.text;
}

TEST(BranchNames, AreMissingBesideInvalidShortHiddenAndUnnamedBranches)
{
  VesselCentreline message = fork();
  message.branches[0].points[3].z = std::numeric_limits<double>::quiet_NaN();
  message.branches[1].name = "branch_3";
  message.branches[2].radii.pop_back();
  message.branches[3] = branch("short", {0, 0, 0}, {0, 0, 0.01});
  message.branches[4] = branch("behind_the_eye", {0, -2, 0}, {0, -2, 0.5});
  message.branches[5] = branch("", {0, 0, 0}, {0, 0, 0.1});
  const std::vector<BranchName> names = branchNames(message, viewFromTheFront(), 13.0);
  ASSERT_EQ(names.size(), 1U);
  EXPECT_EQ(names[0].text, "left internal iliac");
  EXPECT_TRUE(branchNames({}, viewFromTheFront(), 13.0).empty());
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
