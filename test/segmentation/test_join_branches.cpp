#include "segmentation/join_branches.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "segmentation/lumen/lumen_fit.h"
#include "test/common/input_error_of.h"

namespace endovascular_sim::segmentation
{
namespace
{

/** Piece of a vessel with a constant radius [mm]. */
struct Piece
{
  Eigen::Vector3d from;
  Eigen::Vector3d to;
  double radius;
};

/** Angiogram without Hounsfield units of pieces of vessels: 1000 in the lumen, 100 around it, voxels of 0.7 mm. */
image::Volume angiogram(const std::vector<Piece>& pieces)
{
  constexpr double kVoxel = 0.7;
  image::Volume volume;
  volume.modality = image::Modality::kOther;
  volume.grid.size = {90, 50, 140};
  volume.grid.spacing.setConstant(1e-3 * kVoxel);
  for (int k = 0; k < volume.grid.size.z(); ++k)
    for (int j = 0; j < volume.grid.size.y(); ++j)
      for (int i = 0; i < volume.grid.size.x(); ++i)
      {
        const Eigen::Vector3d p = kVoxel * Eigen::Vector3d(i, j, k);
        double depth = -1e30;
        for (const Piece& piece : pieces)
        {
          const Eigen::Vector3d step = piece.to - piece.from;
          const double t = std::clamp((p - piece.from).dot(step) / step.squaredNorm(), 0.0, 1.0);
          depth = std::max(depth, piece.radius - (piece.from + t * step - p).norm());
        }
        volume.stored.push_back(static_cast<std::int16_t>(100.0 + 900.0 * std::clamp(0.5 + depth / kVoxel, 0.0, 1.0)));
      }
  return volume;
}

using Places = std::vector<Eigen::Vector3d>;

/** Clicks into branches, in mm. */
ClickSet clicksAt(const std::vector<std::pair<std::string, Places>>& branches)
{
  ClickSet set;
  set.file = "clicks.yaml";
  for (const auto& [name, places] : branches)
  {
    BranchClicks branch;
    branch.name = name;
    for (const Eigen::Vector3d& p : places)
      branch.clicks.push_back({1e-3 * p, "line"});
    set.branches.push_back(branch);
  }
  return set;
}

Segmentation joined(const std::vector<Piece>& pieces, const ClickSet& clicks)
{
  const Scan scan(angiogram(pieces));
  const EdgeSettings settings = edgeSettings(scan.modality(), scan.spacing());
  Segmentation result = segmentBranches(scan, clicks, settings, 1);
  joinBranches(scan, clicks, settings, 1, result);
  return result;
}

bool holds(const std::vector<std::string>& warnings, const std::string& text)
{
  return std::any_of(warnings.begin(), warnings.end(),
                     [&text](const std::string& warning) { return warning.find(text) != std::string::npos; });
}

const std::vector<Piece> kFork = {
    {{30, 17, 88}, {30, 17, 42}, 6.0}, {{30, 17, 42}, {17, 17, 6}, 4.0}, {{30, 17, 42}, {43, 17, 6}, 4.0}};

TEST(JoinBranches, ABranchOfAForkJoinsTheTrunkRatherThanItsNearerSister)
{
  // The first clicks into the branches are 15 mm apart, and 29 mm away from the last click into the trunk.
  const Segmentation result = joined(kFork, clicksAt({{"trunk", {{30, 17, 84}, {30, 17, 50}}},
                                                      {"left", {{22.5, 17, 22}, {18, 17, 9}}},
                                                      {"right", {{37.5, 17, 22}, {42, 17, 9}}}}));
  ASSERT_EQ(result.branches.size(), 3U);
  EXPECT_EQ(result.branches[1].parent, 0);
  EXPECT_EQ(result.branches[2].parent, 0);
  EXPECT_TRUE(holds(result.warnings, "left: was extended by about"));
  for (const LumenBranch& branch : result.branches)
    for (const Section& section : branch.sections)
      EXPECT_GT(section.diameter(), 6e-3) << branch.name;
}

TEST(JoinBranches, ABranchWithoutALumenBetweenItAndItsParentIsRefused)
{
  const std::vector<Piece> pieces = {{{15, 17, 88}, {15, 17, 8}, 5.0}, {{40, 17, 88}, {40, 17, 8}, 3.0}};
  const std::string text = inputErrorOf(
      [&] {
        joined(pieces, clicksAt({{"trunk", {{15, 17, 84}, {15, 17, 12}}}, {"apart", {{40, 17, 60}, {40, 17, 12}}}}));
      });
  EXPECT_NE(text.find("apart"), std::string::npos) << text;
  EXPECT_NE(text.find("leaves the contrast at"), std::string::npos) << text;
}

TEST(JoinBranches, APathOfSeveralTimesTheDistanceOfItsClicksIsRefused)
{
  const std::vector<Piece> loop = {
      {{20, 17, 12}, {20, 17, 80}, 3.0}, {{20, 17, 80}, {34, 17, 80}, 3.0}, {{34, 17, 80}, {34, 17, 12}, 3.0}};
  const auto errorOf = [&loop](const Places& places) {
    return inputErrorOf([&] { joined(loop, clicksAt({{"loop", places}})); });
  };
  EXPECT_NE(errorOf({{20, 17, 20}, {34, 17, 20}}).find("times the distance of its clicks"), std::string::npos);
  EXPECT_EQ(errorOf({{20, 17, 20}, {27, 17, 80}, {34, 17, 20}}), "");
  EXPECT_EQ(errorOf({{20, 17, 20}, {20, 17, 70}}), "");
}

TEST(JoinBranches, APathAcrossTheWallBetweenTwoVesselsIsRefusedWithItsPlace)
{
  const std::vector<Piece> pieces = {{{20, 17, 10}, {20, 17, 42}, 3.0}, {{27.8, 17, 38}, {27.8, 17, 88}, 3.0}};
  const std::string error = inputErrorOf(
      [&] {
        joined(pieces, clicksAt({{"artery", {{20, 17, 14}, {27.8, 17, 84}}}}));
      });
  EXPECT_NE(error.find("artery: the path between clicks 1 and 2 crosses a dark place at ("), std::string::npos)
      << error;
  EXPECT_FALSE(holds(joined(kFork, clicksAt({{"trunk", {{30, 17, 84}, {30, 17, 50}}}})).warnings, "vanishes"));
}

TEST(JoinBranches, AClickAtTheEdgeOfAVesselInAnMrImageGetsIntoIt)
{
  const std::vector<Piece> pieces = {{{30, 17, 10}, {30, 17, 88}, 3.0}};
  const Segmentation central = joined(pieces, clicksAt({{"artery", {{30, 17, 20}, {30, 17, 80}}}}));
  const Segmentation edge = joined(pieces, clicksAt({{"artery", {{33.1, 17, 20}, {27.0, 17, 80}}}}));
  const auto middle = [](const Segmentation& s) { return s.branches[0].sections[s.branches[0].sections.size() / 2]; };
  EXPECT_NEAR(middle(edge).diameter(), middle(central).diameter(), 2e-5);
  EXPECT_NEAR(middle(edge).diameter(), 6e-3, 3e-4);
}

}  // namespace
}  // namespace endovascular_sim::segmentation
