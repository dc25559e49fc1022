#include "segmentation/labels/mask_repair.h"

#include <gtest/gtest.h>

#include "segmentation/labels/mask_topology.h"
#include "test/segmentation/label_maps.h"

namespace endovascular_sim::segmentation
{
namespace
{

/** Mask of tubes in a box of 40 mm. */
VoxelMask maskOfTubes(const std::vector<ExactTube>& tubes, const Eigen::Vector3d& spacing = {1e-3, 1e-3, 1e-3})
{
  const Eigen::Vector3i size = Eigen::Vector3d::Constant(0.04).cwiseQuotient(spacing).array().round().cast<int>();
  return maskOf(labelMapOf(tubes, size, spacing, Eigen::Vector3d::Zero()), 2);
}

const ExactTube kTube{{{0.02, 0.02, 0.006}, {0.02, 0.02, 0.034}}, 0.005};

/** Difference of two masks in voxels. */
std::size_t difference(const VoxelMask& a, const VoxelMask& b)
{
  std::size_t count = 0;
  for (std::size_t n = 0; n < a.inside.size(); ++n)
    count += a.inside[n] != b.inside[n] ? 1U : 0U;
  return count;
}

TEST(MaskRepair, ChangesNothingOfATube)
{
  VoxelMask mask = maskOfTubes({kTube});
  const VoxelMask before = mask;
  const MaskChanges changes = repairMask(mask, {});
  EXPECT_EQ(mask.inside, before.inside);
  EXPECT_TRUE(changes.islands.empty() && changes.joints.empty() && changes.tunnels.empty() &&
              changes.cut_loops.empty());
  EXPECT_EQ(changes.cavities, 0U);
}

TEST(MaskRepair, RemovesIslandsAndReportsThem)
{
  VoxelMask mask = maskOfTubes({kTube});
  const VoxelMask before = mask;
  mask.inside[mask.offset({6, 6, 6})] = 1;
  for (int i = 30; i < 34; ++i)
    mask.inside[mask.offset({i, 33, 30})] = 1;
  const MaskChanges changes = repairMask(mask, {});
  EXPECT_EQ(mask.inside, before.inside);
  ASSERT_EQ(changes.islands.size(), 2U);
  EXPECT_EQ(changes.islands[0].voxels, 4U);
  EXPECT_NEAR(changes.islands[1].volume, 1e-9, 1e-15);
  EXPECT_NEAR((changes.islands[1].location - Eigen::Vector3d::Constant(4e-3)).norm(), 0.0, 1e-9);
}

TEST(MaskRepair, FillsCavities)
{
  VoxelMask mask = maskOfTubes({kTube});
  const VoxelMask before = mask;
  for (int k = 18; k < 22; ++k)
    mask.inside[mask.offset({22, 22, k})] = 0;
  mask.inside[mask.offset({22, 24, 12})] = 0;
  const MaskChanges changes = repairMask(mask, {});
  EXPECT_EQ(mask.inside, before.inside);
  EXPECT_EQ(changes.cavities, 2U);
  EXPECT_EQ(changes.cavity_voxels, 5U);
}

class MaskRepairOfATunnel : public ::testing::TestWithParam<double>
{
};

TEST_P(MaskRepairOfATunnel, FillsItAlongItsWholeLength)
{
  VoxelMask mask = maskOfTubes({kTube});
  const VoxelMask before = mask;
  const ExactTube hole{{{0.0, 0.021, 0.02}, {0.04, 0.019, 0.02}}, GetParam()};
  std::size_t removed = 0;
  for (std::size_t n = 0; n < mask.inside.size(); ++n)
    if (mask.inside[n] != 0 && hole.at(mask.centreOf(n)) < 0.0)
    {
      mask.inside[n] = 0;
      ++removed;
    }
  ASSERT_EQ(handlesOf(mask), 1);
  const MaskChanges changes = repairMask(mask, {});
  EXPECT_EQ(handlesOf(mask), 0);
  ASSERT_EQ(changes.tunnels.size(), 1U);
  EXPECT_TRUE(changes.cut_loops.empty());
  EXPECT_NEAR((changes.tunnels[0] - Eigen::Vector3d(0.02, 0.02, 0.02)).norm(), 0.0, 6e-3);
  EXPECT_LT(difference(mask, before), removed / 4 + 4);
}

INSTANTIATE_TEST_SUITE_P(Radii, MaskRepairOfATunnel, ::testing::Values(0.0008, 0.0015, 0.0022));

TEST(MaskRepair, CutsARingWhereItIsThinnest)
{
  // A ring of vessels whose thinnest place lies at +y.
  const Eigen::Vector3d centre(0.02, 0.02, 0.02);
  const auto x = Eigen::Vector3d::UnitX();
  const auto y = Eigen::Vector3d::UnitY();
  std::vector<ExactTube> tubes = {{arc(centre, 0.012, x, y, 0.6 * M_PI, 2.4 * M_PI), 0.003},
                                  {arc(centre, 0.012, x, y, 0.4 * M_PI, 0.6 * M_PI), 0.0016}};
  VoxelMask mask = maskOfTubes(tubes);
  ASSERT_EQ(handlesOf(mask), 1);
  const std::size_t before = mask.voxels();
  const MaskChanges changes = repairMask(mask, {});
  EXPECT_EQ(handlesOf(mask), 0);
  EXPECT_TRUE(changes.tunnels.empty());
  ASSERT_EQ(changes.cut_loops.size(), 1U);
  EXPECT_NEAR((changes.cut_loops[0] - (centre + 0.012 * y)).norm(), 0.0, 5e-3);
  EXPECT_LT(before - mask.voxels(), 40U);
}

TEST(MaskRepair, JoinsLabelsThatAGapOfAVoxelSeparates)
{
  const ExactTube lower{{{0.02, 0.02, 0.006}, {0.02, 0.02, 0.015}}, 0.004};
  const ExactTube upper{{{0.02, 0.02, 0.0245}, {0.02, 0.02, 0.034}}, 0.004};
  VoxelMask mask = maskOfTubes({lower, upper});
  std::vector<int> component;
  ASSERT_EQ(componentsOf(mask, 1, component).size(), 2U);
  const MaskChanges changes = repairMask(mask, {});
  EXPECT_EQ(componentsOf(mask, 1, component).size(), 1U);
  EXPECT_EQ(changes.joints.size(), 1U);
  EXPECT_TRUE(changes.islands.empty());
  EXPECT_EQ(handlesOf(mask), 0);
}

TEST(MaskRepair, KeepsThePieceThatAClickWants)
{
  const ExactTube small{{{0.006, 0.006, 0.01}, {0.006, 0.006, 0.03}}, 0.003};
  VoxelMask mask = maskOfTubes({kTube, small});
  const std::size_t voxels = maskOfTubes({small}).voxels();
  const MaskChanges changes = repairMask(mask, {{0.006, 0.007, 0.012}});
  EXPECT_EQ(mask.voxels(), voxels);
  EXPECT_EQ(changes.islands.size(), 1U);
}

}  // namespace
}  // namespace endovascular_sim::segmentation
