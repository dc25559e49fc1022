#include "segmentation/labels/mask_border.h"

#include <gtest/gtest.h>

#include "segmentation/labels/mask_topology.h"
#include "test/segmentation/label_maps.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr int kMargin = 2;

VoxelMask maskOfTubes(const std::vector<ExactTube>& tubes)
{
  return maskOf(labelMapOf(tubes, {40, 40, 40}, Eigen::Vector3d::Constant(1e-3), Eigen::Vector3d::Zero()), kMargin);
}

TEST(MaskBorder, IsAnEndWhereATubeLeavesTheImage)
{
  for (const Eigen::Vector3d& step : {Eigen::Vector3d(0.0, 0.0, 1.0), Eigen::Vector3d(0.5, 0.2, 1.0)})
  {
    const Eigen::Vector3d middle = Eigen::Vector3d::Constant(0.0195);
    VoxelMask mask = maskOfTubes({{{middle - 0.05 * step, middle + 0.05 * step}, 0.005}});
    std::vector<Eigen::Vector3d> touches;
    const std::vector<BorderEnd> ends = continueBeyondBorder(mask, kMargin, touches);
    ASSERT_EQ(ends.size(), 2U);
    EXPECT_TRUE(touches.empty());
    EXPECT_NEAR(ends[0].point.z(), -5e-4, 1e-9);
    EXPECT_NEAR(ends[1].point.z(), 39.5e-3, 1e-9);
    EXPECT_EQ(ends[1].outward, Eigen::Vector3d::UnitZ());
    EXPECT_NEAR((ends[1].point - middle - 0.02 / step.z() * step).norm(), 0.0, 5e-4);
    EXPECT_NEAR(ends[1].radius, 0.005 * std::sqrt(step.norm() / step.z()), 3e-4);
    EXPECT_EQ(handlesOf(mask), 0);
    // The continuation has the width of the last layer.
    EXPECT_TRUE(
        mask.at(((ends[1].point + Eigen::Vector3d(0.0, 0.0, 0.004) - mask.first) / 1e-3).array().round().cast<int>()));
  }
}

TEST(MaskBorder, IsNoEndWhereATubeRunsAlongIt)
{
  for (const double depth : {0.0, 0.4e-3, 0.9e-3})
    for (const double radius : {0.002, 0.005})
    {
      const double y = radius - depth;
      VoxelMask mask = maskOfTubes({{{{0.02, y, 0.006}, {0.02, y, 0.034}}, radius}});
      std::vector<Eigen::Vector3d> touches;
      EXPECT_TRUE(continueBeyondBorder(mask, kMargin, touches).empty()) << depth << ", " << radius;
    }
}

TEST(MaskBorder, OfATightBoxIsNoEndBesideAnArch)
{
  const Eigen::Vector3d centre(0.0195, 0.0195, 0.0);
  VoxelMask mask = maskOfTubes(
      {{arc(centre, 0.0135, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ(), -0.5, M_PI + 0.5), 0.0065}});
  VoxelMask tight = mask;
  tight.size.z() = 22 + kMargin;  // the arch ends at z = 20 mm
  tight.inside.resize(VoxelMask::count(tight.size));
  for (int layer = 0; layer < kMargin; ++layer)
    for (int j = 0; j < tight.size.y(); ++j)
      for (int i = 0; i < tight.size.x(); ++i)
        tight.inside[tight.offset({i, j, tight.size.z() - 1 - layer})] = 0;
  std::vector<Eigen::Vector3d> touches;
  const std::vector<BorderEnd> ends = continueBeyondBorder(tight, kMargin, touches);
  EXPECT_EQ(ends.size(), 2U);
  for (const BorderEnd& end : ends)
    EXPECT_EQ(end.outward, -Eigen::Vector3d::UnitZ());
}

}  // namespace
}  // namespace endovascular_sim::segmentation
