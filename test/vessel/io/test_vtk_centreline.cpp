#include "test/common/input_error_of.h"
#include "vessel/io/vtk_centreline.h"

#include <gtest/gtest.h>

#include "test/vessel/io/vtk_files.h"
#include "test/vessel/repair/swept_meshes.h"

namespace endovascular_sim::vessel
{
namespace
{

using Points = std::vector<Eigen::Vector3d>;

const geometry::MeshDistance kTube(sweep(straightLine(0.1), circle(4e-3)));

/** Points from one place to another, 0.5 mm apart [mm]. */
Points segment(const Eigen::Vector3d& from, const Eigen::Vector3d& to)
{
  Points points;
  const int count = static_cast<int>((to - from).norm() / 0.5);
  for (int k = 0; k <= count; ++k)
    points.emplace_back(from + (to - from) * k / count);
  return points;
}

Points joined(Points first, const Points& second)
{
  first.insert(first.end(), second.begin() + 1, second.end());
  return first;
}

/** Lines of a file in millimetres, with the radius of each. */
VtkPolyData dataOf(const std::vector<Points>& lines, double radius)
{
  VtkPolyData data;
  for (const Points& line : lines)
  {
    for (const Eigen::Vector3d& p : line)
    {
      data.lines.points.push_back(static_cast<long long>(data.points.size()));
      data.points.push_back(p);
      if (radius > 0.0)
        data.radii.push_back(radius);
    }
    data.lines.ends.push_back(data.lines.points.size());
  }
  return data;
}

CentrelineTree treeOf(const VtkPolyData& data)
{
  return vtkCentreline(data, 1e-3, kTube, "c.vtp");
}

double lengthOf(const CentrelineBranch& branch)
{
  double length = 0.0;
  for (std::size_t k = 1; k < branch.points.size(); ++k)
    length += (branch.points[k] - branch.points[k - 1]).norm();
  return length;
}

const Points kTrunk = segment({0, 0, 0}, {0, 0, 50});
const Points kLeft = segment({0, 0, 50}, {30, 0, 90});
const Points kRight = segment({0, 0, 50}, {-30, 0, 90});

void expectFork(const CentrelineTree& tree)
{
  ASSERT_EQ(tree.branches.size(), 2U);
  EXPECT_EQ(tree.branches[0].parent, -1);
  EXPECT_EQ(tree.branches[1].parent, 0);
  EXPECT_NEAR(lengthOf(tree.branches[0]), 0.1, 1e-3);
  EXPECT_NEAR(lengthOf(tree.branches[1]), 0.05, 1e-3);
  EXPECT_LT(std::abs(tree.branches[1].points.front().x()), 1e-3);
  EXPECT_EQ(centrelineEnds(tree).size(), 3U);
  EXPECT_NEAR(tree.branches[1].radii.back(), 2e-3, 1e-12);
}

TEST(VtkCentreline, PathsThatShareTheirBeginBecomeATree)
{
  expectFork(treeOf(dataOf({joined(kTrunk, kLeft), joined(kTrunk, kRight)}, 2.0)));
}

TEST(VtkCentreline, PathsNeedNotShareTheirPointsExactly)
{
  Points right = joined(kTrunk, kRight);
  for (std::size_t k = 0; k < right.size(); ++k)
    right[k].y() += 0.1 * std::sin(0.3 * static_cast<double>(k));
  expectFork(treeOf(dataOf({joined(kTrunk, kLeft), right}, 2.0)));
}

TEST(VtkCentreline, PiecesBetweenForksBecomeATreeInAnyOrderAndDirection)
{
  Points trunk = kTrunk;
  Points left = kLeft;
  std::reverse(trunk.begin(), trunk.end());
  std::reverse(left.begin(), left.end());
  VtkPolyData data = dataOf({left, kRight, trunk}, 2.0);
  data.radii.back() = 3.0;  // the widest end is the root
  const CentrelineTree tree = treeOf(data);
  ASSERT_EQ(tree.branches.size(), 3U);
  EXPECT_LT(tree.branches[0].points.front().norm(), 1e-9);
  EXPECT_EQ(tree.branches[1].parent, 0);
  EXPECT_EQ(tree.branches[2].parent, 0);
  EXPECT_EQ(centrelineEnds(tree).size(), 4U - 1U + 0U) << "the root's two ends, of which the fork is none";
}

TEST(VtkCentreline, RadiiAreMeasuredWhereTheFileHasNone)
{
  const CentrelineTree tree = treeOf(dataOf({segment({0, 0, 10}, {0, 0, 90})}, 0.0));
  for (const double radius : tree.branches[0].radii)
    EXPECT_NEAR(radius, 4e-3, 2e-5);
}

TEST(VtkCentreline, IsTurnedFromRas)
{
  VtkPolyData data = dataOf({segment({1, 2, 10}, {1, 2, 90})}, 2.0);
  data.space = "SPACE=RAS";
  EXPECT_LT((treeOf(data).branches[0].points.front() - Eigen::Vector3d(-1e-3, -2e-3, 10e-3)).norm(), 1e-12);
}

std::string refusalOf(const VtkPolyData& data)
{
  return inputErrorOf([&] { treeOf(data); });
}

TEST(VtkCentreline, RefusesLinesThatDoNotMeetAndFilesWithoutLines)
{
  EXPECT_NE(refusalOf(dataOf({kTrunk, segment({50, 0, 0}, {50, 0, 40})}, 2.0)).find("do not meet the others"),
            std::string::npos);
  EXPECT_NE(refusalOf(VtkPolyData()).find("has no lines"), std::string::npos);
  std::vector<Points> chain;
  for (int k = 0; k < 501; ++k)
    chain.push_back({{0, 0, 1.0 * k}, {0, 0, k + 1.0}});
  EXPECT_NE(refusalOf(dataOf(chain, 2.0)).find("has 501 lines"), std::string::npos);
  VtkPolyData data = dataOf({kTrunk}, 2.0);
  data.lines.points.back() = 5000;
  EXPECT_NE(refusalOf(data).find("names point 5000"), std::string::npos);
}

TEST(VtkCentreline, ManyPiecesInReverseOrderBecomeAChain)
{
  std::vector<Points> chain;
  for (int k = 0; k < 500; ++k)
    chain.push_back({{0, 0, 5.0 * k}, {0, 0, 5.0 * k + 5.0}});
  std::reverse(chain.begin(), chain.end());
  VtkPolyData data = dataOf(chain, 2.0);
  data.radii[data.radii.size() - 2] = 3.0;  // the free end of the last piece is the root
  EXPECT_EQ(treeOf(data).branches.size(), 500U);
}

TEST(VtkCentreline, EveryStorageGivesTheSameTree)
{
  const VtkPolyData data = dataOf({joined(kTrunk, kLeft), joined(kTrunk, kRight)}, 2.0);
  VtkContent content;
  content.points = data.points;
  content.radii = data.radii;
  for (std::size_t k = 0; k < data.lines.size(); ++k)
  {
    const std::vector<long long> cell = data.lines.cell(k);
    content.lines.emplace_back(cell.begin(), cell.end());
  }
  for (const VtkStorage storage : kVtkStorages)
  {
    const std::string name = std::string("c") + extensionOf(storage);
    expectFork(vtkCentreline(readVtkPolyData(vtkFile(content, storage), name), 1e-3, kTube, name));
  }
}

}  // namespace
}  // namespace endovascular_sim::vessel
