#include "rviz_plugin/picture/branch_names.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "nodes/visualization/motion_history.h"
#include "test/rviz_plugin/moved_patient.h"

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

/** Straight branch across the picture of a view from the front. */
visualization::BranchToName straightBranch(const std::string& text, double height)
{
  visualization::BranchToName branch;
  branch.text = text;
  branch.size = sizeOf(text);
  for (int k = -40; k <= 40; ++k)
  {
    branch.points.emplace_back(1e-3 * k, 0.0, height);
    branch.radii.push_back(2e-3);
  }
  return branch;
}

visualization::PictureView viewFromTheFront()
{
  visualization::PictureView view;
  view.eye = {0.0, -0.2, 0.0};
  return view;
}

std::vector<visualization::BranchToName> twoBranches()
{
  return {straightBranch("upper branch", 0.02), straightBranch("lower branch", -0.02)};
}

/** Distance of a point from the centreline of a moved branch [m]. */
double distanceFrom(const visualization::BranchToName& branch, const Eigen::Vector3d& point,
                    const motion::MotionMap& map)
{
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& rest : branch.points)
    least = std::min(least, (map.position(rest) - point).norm());
  return least;
}

/** End of a name's leader; far away without one. */
Eigen::Vector3d endOf(const MovingNames& names, const std::string& text)
{
  for (const visualization::PlacedName& name : names.names())
    if (name.text == text)
      return name.end;
  return Eigen::Vector3d::Constant(1e3);
}

TEST(MovingNames, ArePlacedBesideTheMovedBranches)
{
  const motion::MotionMap map = movedLargePatient();
  MovingNames names;
  names.place(twoBranches(), viewFromTheFront(), map);
  ASSERT_EQ(names.names().size(), 2U);
  for (const visualization::BranchToName& branch : twoBranches())
    EXPECT_LT(distanceFrom(branch, endOf(names, branch.text), map), 2e-3) << "in the lumen of the moved branch";
  std::vector<visualization::BranchToName> moved = twoBranches();
  for (visualization::BranchToName& branch : moved)
    for (Eigen::Vector3d& point : branch.points)
      point = map.position(point);
  const std::vector<visualization::PlacedName> expected = visualization::placeNames(moved, viewFromTheFront());
  for (std::size_t k = 0; k < 2; ++k)
  {
    EXPECT_EQ(names.names()[k].end, expected[k].end);
    EXPECT_EQ(names.names()[k].offset, expected[k].offset);
  }
}

TEST(MovingNames, EndsOfTheLeadersLieWhereTheMapPutsThem)
{
  MovingNames names;
  names.place(twoBranches(), viewFromTheFront(), nodes::restingMap());
  const std::vector<visualization::PlacedName> rest = names.names();
  ASSERT_EQ(rest.size(), 2U);
  const motion::MotionMap map = movedLargePatient();
  EXPECT_TRUE(names.move(map));
  for (std::size_t k = 0; k < 2; ++k)
  {
    EXPECT_EQ(names.names()[k].end, map.position(rest[k].end));
    EXPECT_GT((names.names()[k].end - rest[k].end).norm(), 5e-3);
    EXPECT_EQ(names.names()[k].offset, rest[k].offset) << "the name stays beside its branch";
  }
  EXPECT_FALSE(names.move(map)) << "nothing has moved since";
  EXPECT_TRUE(names.move(nodes::restingMap()));
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_EQ(names.names()[k].end, rest[k].end);
}

TEST(MovingNames, PlacedInAMovedPatientMoveBackWithIt)
{
  MovingNames names;
  names.place(twoBranches(), viewFromTheFront(), movedLargePatient());
  names.move(nodes::restingMap());
  for (const visualization::BranchToName& branch : twoBranches())
    EXPECT_LT(distanceFrom(branch, endOf(names, branch.text), nodes::restingMap()), 2e-3);
}

TEST(MovingNames, InAPatientAtRestAreThoseOfThePlacement)
{
  MovingNames names;
  names.place(twoBranches(), viewFromTheFront(), nodes::restingMap());
  EXPECT_FALSE(names.move(nodes::restingMap()));
  const std::vector<visualization::PlacedName> expected = visualization::placeNames(twoBranches(), viewFromTheFront());
  ASSERT_EQ(names.names().size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k)
    EXPECT_EQ(names.names()[k].end, expected[k].end);
  names.clear();
  EXPECT_TRUE(names.empty());
  EXPECT_FALSE(names.move(movedLargePatient()));
}

}  // namespace
}  // namespace endovascular_sim::rviz_plugin
