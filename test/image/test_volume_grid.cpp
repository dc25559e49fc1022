#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "image/volume_grid.h"
#include "test/common/input_error_of.h"

namespace endovascular_sim::image
{
namespace
{

using Eigen::Vector3d;

VolumeGrid obliqueGrid()
{
  VolumeGrid grid;
  grid.size = {7, 6, 5};
  grid.spacing = {0.7e-3, 0.9e-3, 1.25e-3};
  grid.origin = {-0.0125, 0.031, 0.407};
  grid.axes =
      (Eigen::AngleAxisd(0.3, Vector3d::UnitX()) * Eigen::AngleAxisd(-0.2, Vector3d::UnitY())).toRotationMatrix();
  return grid;
}

/** Message of the rejection of a grid; empty without one. */
std::string rejectionOf(const VolumeGrid& grid)
{
  return inputErrorOf([&] { requireValid(grid, "head.mha"); });
}

TEST(VolumeGrid, PositionsFollowTheAxes)
{
  const VolumeGrid grid = obliqueGrid();
  EXPECT_NEAR((grid.position({1, 0, 0}) - grid.origin - 0.7e-3 * grid.axes.col(0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((grid.position({0, 2.5, 0}) - grid.origin - 2.25e-3 * grid.axes.col(1)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((grid.position({0, 0, -4}) - grid.origin + 5e-3 * grid.axes.col(2)).norm(), 0.0, 1e-15);
}

TEST(VolumeGrid, AVoxelHasThePlaceOfItsIndexInMemory)
{
  const VolumeGrid grid = obliqueGrid();
  EXPECT_EQ(grid.voxels(), 210U);
  EXPECT_EQ(grid.offset(1, 0, 0), 1U);
  EXPECT_EQ(grid.offset(0, 1, 0), 7U);
  EXPECT_EQ(grid.offset(0, 0, 1), 42U);
  EXPECT_EQ(grid.offset(6, 5, 4), 209U);
}

TEST(VolumeGrid, TheBoundsHoldAllCentresAndTouchThem)
{
  const VolumeGrid grid = obliqueGrid();
  Eigen::AlignedBox3d expected;
  for (int k = 0; k < 5; ++k)
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 7; ++i)
        expected.extend(grid.position(Vector3d(i, j, k)));
  EXPECT_NEAR((grid.bounds().min() - expected.min()).norm(), 0.0, 1e-15);
  EXPECT_NEAR((grid.bounds().max() - expected.max()).norm(), 0.0, 1e-15);
}

TEST(VolumeGrid, AWrongGridIsRejectedWithFileAndReason)
{
  EXPECT_EQ(rejectionOf(obliqueGrid()), "");
  VolumeGrid grid = obliqueGrid();
  grid.size.y() = 1;
  EXPECT_NE(rejectionOf(grid).find("head.mha: axis 2: has 1 voxels"), std::string::npos);
  grid = obliqueGrid();
  grid.spacing.z() = 0.0;
  EXPECT_NE(rejectionOf(grid).find("axis 3: its spacing is 0.000000 mm"), std::string::npos);
  grid = obliqueGrid();
  grid.spacing.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(rejectionOf(grid).find("axis 1: its spacing"), std::string::npos);
  grid = obliqueGrid();
  grid.origin.x() = std::numeric_limits<double>::infinity();
  EXPECT_NE(rejectionOf(grid).find("origin"), std::string::npos);
  grid = obliqueGrid();
  grid.axes(0, 1) += 0.01;
  EXPECT_NE(rejectionOf(grid).find("orthogonal"), std::string::npos);
}

}  // namespace
}  // namespace endovascular_sim::image
