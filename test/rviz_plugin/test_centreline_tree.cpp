#include "rviz_plugin/model/centreline_tree.h"

#include <limits>

#include <gtest/gtest.h>

#include "vessel/centreline/branch_finder.h"

namespace endovascular_sim::rviz_plugin
{
namespace
{

VesselCentrelineBranch branch(const std::string& name, const Eigen::Vector3d& step, double height, double radius)
{
  VesselCentrelineBranch message;
  message.name = name;
  for (int k = 0; k <= 20; ++k)
  {
    geometry_msgs::Point point;
    point.x = k * step.x();
    point.z = height + k * step.z();
    message.points.push_back(point);
    message.radii.push_back(radius);
  }
  return message;
}

/** Aorta of 20 mm along z, and a renal artery of 3 mm that begins on its centreline. */
VesselCentreline aortaWithRenalArtery()
{
  VesselCentreline message;
  message.branches = {branch("abdominal_aorta", {0, 0, 0.005}, 0.0, 0.01),
                      branch("right_renal", {0.002, 0, 0}, 0.05, 0.0015)};
  return message;
}

TEST(CentrelineTree, ATipBesideAnOstiumIsInTheParentWhoseLumenHoldsIt)
{
  const vessel::BranchFinder branches(centrelineTree(aortaWithRenalArtery()));
  // The nearest point of a centreline is one of the renal artery, 3 mm away; the tip is in the aorta.
  EXPECT_EQ(branches.nameAt({0.006, 0.0, 0.053}), "abdominal aorta");
  EXPECT_EQ(branches.nameAt({0.015, 0.0, 0.05}), "right renal");
}

TEST(CentrelineTree, InvalidBranchesHaveNoPoints)
{
  VesselCentreline message = aortaWithRenalArtery();
  message.branches[0].points[3].z = std::numeric_limits<double>::quiet_NaN();
  const vessel::CentrelineTree tree = centrelineTree(message);
  EXPECT_TRUE(tree.branches[0].points.empty());
  EXPECT_EQ(vessel::BranchFinder(tree).nameAt({0.0, 0.0, 0.0}), "right renal");
  message.branches[1].radii.pop_back();
  EXPECT_EQ(vessel::BranchFinder(centrelineTree(message)).nameAt({0.0, 0.0, 0.0}), "");
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
