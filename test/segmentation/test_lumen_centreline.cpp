#include "segmentation/lumen_centreline.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "segmentation/gentle_bends.h"
#include "test/segmentation/written_centreline.h"

namespace endovascular_sim::segmentation
{
namespace
{

/** Tube along points with circular contours. */
LumenBranch tubeAlong(const std::string& name, int parent, double radius, const std::vector<Eigen::Vector3d>& points)
{
  LumenBranch branch;
  branch.name = name;
  branch.parent = parent;
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    Section section;
    section.centre = points[k];
    section.tangent = (points[std::min(k + 1, points.size() - 1)] - points[k == 0 ? 0 : k - 1]).normalized();
    section.u = section.tangent.unitOrthogonal();
    section.w = section.tangent.cross(section.u);
    section.radii.fill(radius);
    branch.sections.push_back(section);
  }
  return branch;
}

TEST(LumenCentreline, ANarrowBranchNearAnEndOfAWideTrunkLeavesTheEndOpen)
{
  // Right coronary artery just above the aortic valve.
  std::vector<Eigen::Vector3d> aorta;
  std::vector<Eigen::Vector3d> coronary;
  for (int k = 0; k <= 30; ++k)
    aorta.emplace_back(0.0, 0.0, 1e-3 * k);
  for (int k = 0; k <= 60; ++k)
    coronary.emplace_back(1e-3 * k, 0.0, 0.004);
  const std::vector<LumenBranch> branches = {tubeAlong("aorta", -1, 0.015, aorta),
                                             tubeAlong("coronary", 0, 0.002, coronary)};
  EXPECT_EQ(openEnds(lumenCentreline(branches)).size(), 3U);
}

TEST(LumenCentreline, OfAWideForkIsAnAnatomy)
{
  // Iliac arteries: each path follows the aorta and turns to its side on the spot.
  std::vector<Eigen::Vector3d> aorta;
  for (int k = 0; k <= 80; ++k)
    aorta.emplace_back(0.0, 0.0, 0.08 - 1e-3 * k);
  const auto iliac = [](double side)
  {
    std::vector<Eigen::Vector3d> points;
    for (int k = 0; k < 12; ++k)
      points.emplace_back(0.0, 0.0, 0.012 - 1e-3 * k);
    for (int k = 0; k < 50; ++k)
      points.emplace_back(side * 8e-4 * k, 0.0, -6e-4 * k);
    return points;
  };
  const std::vector<LumenBranch> branches = {tubeAlong("aorta", -1, 0.009, aorta),
                                             tubeAlong("left", 0, 0.006, iliac(1.0)),
                                             tubeAlong("right", 1, 0.006, iliac(-1.0))};
  const vessel::CentrelineTree tree = lumenCentreline(branches);
  const std::vector<vessel::AnatomyChain> chains = writtenChains(tree);
  EXPECT_EQ(chains.size(), 3U);
  for (const vessel::CentrelineBranch& branch : tree.branches)
    EXPECT_GE(bendRatio(branch), 1.0) << branch.name;
  EXPECT_EQ(openEnds(tree).size(), 3U);
  EXPECT_NEAR(tree.branches[2].radii.back(), 0.006, 1e-6);
}

}  // namespace
}  // namespace endovascular_sim::segmentation
