#include "patient/volume/lumen_mask.h"

#include <gtest/gtest.h>

#include <numeric>

#include "geometry/mesh_distance.h"
#include "patient/tissue/tissue.h"
#include "test/fluoroscopy/shapes.h"
#include "test/patient/volume_shapes.h"

namespace endovascular_sim::patient
{
namespace
{

void expectWindingNumbers(const image::VolumeGrid& grid, const geometry::TriangleMesh& mesh)
{
  const VoxelMask mask = lumenMask(grid, mesh);
  int inside = 0;
  for (int z = 0; z < grid.size.z(); ++z)
    for (int y = 0; y < grid.size.y(); ++y)
      for (int x = 0; x < grid.size.x(); ++x)
      {
        const bool expected = geometry::windingNumber(mesh, grid.position(Eigen::Vector3d(x, y, z))) > 0.5;
        ASSERT_EQ(mask[grid.offset(x, y, z)] != 0, expected) << x << " " << y << " " << z;
        inside += expected ? 1 : 0;
      }
  EXPECT_GT(inside, 100);
}

TEST(LumenMask, EqualsTheWindingNumberAtEveryVoxel)
{
  expectWindingNumbers(cubicGrid(24, 2e-3), fluoroscopy::sphere({1.1e-3, -2.3e-3, 0.7e-3}, 0.019, 13, 17));
}

TEST(LumenMask, EqualsTheWindingNumberInARotatedAndMirroredLattice)
{
  image::VolumeGrid grid = cubicGrid(24, 2e-3);
  grid.axes = Eigen::AngleAxisd(0.8, Eigen::Vector3d(1.0, 1.0, 0.3).normalized()).toRotationMatrix();
  grid.origin = grid.axes * grid.origin;
  expectWindingNumbers(grid, fluoroscopy::cylinder({-0.013, 0.001, -0.011}, {0.012, 0.003, 0.014}, 0.006, 23));
  grid.axes.col(0) *= -1.0;
  grid.origin = -grid.axes * (0.023 * Eigen::Vector3d::Ones());
  expectWindingNumbers(grid, fluoroscopy::cylinder({-0.013, 0.001, -0.011}, {0.012, 0.003, 0.014}, 0.006, 23));
}

TEST(LumenMask, LinesThroughEdgesAndVerticesAreCountedOnce)
{
  // An octahedron whose vertices and edges lie on lines of voxels.
  const geometry::TriangleMesh mesh = fluoroscopy::sphere(Eigen::Vector3d::Zero(), 8.0, 2, 4);
  image::VolumeGrid grid = cubicGrid(25, 1.0);
  grid.spacing.setConstant(1.0);
  const VoxelMask mask = lumenMask(grid, mesh);
  for (int z = 0; z < 25; ++z)
    for (int y = 0; y < 25; ++y)
      for (int x = 0; x < 25; ++x)
      {
        const int norm = std::abs(x - 12) + std::abs(y - 12) + std::abs(z - 12);
        if (norm != 8)
        {
          EXPECT_EQ(mask[grid.offset(x, y, z)] != 0, norm < 8) << x << " " << y << " " << z;
        }
      }
}

TEST(LumenMask, IsWidenedByWholeVoxels)
{
  const image::VolumeGrid grid = cubicGrid(9, 1e-3);
  VoxelMask mask(grid.voxels(), 0);
  mask[grid.offset(4, 4, 4)] = mask[grid.offset(0, 8, 4)] = 1;
  const VoxelMask wide = dilated(grid, mask, 1);
  EXPECT_EQ(std::accumulate(wide.begin(), wide.end(), 0), 27 + 12);
  EXPECT_EQ(wide[grid.offset(3, 5, 4)], 1);
  EXPECT_EQ(dilated(grid, mask, 0), mask);
}

TEST(LumenMask, ContrastMediumIsReplacedByBloodInLumenAndRimOnly)
{
  DensityVolume volume(cubicGrid(20, 1e-3));
  for (std::uint16_t& voxel : volume.voxels())
    voxel = DensityVolume::encode({1000.0, 200.0});  // iodine of 300 HU reads as bone
  volume.set(2, 10, 10, {260.0, 0.0});
  const VoxelMask lumen = lumenMask(volume.grid(), fluoroscopy::sphere(Eigen::Vector3d::Zero(), 5.2e-3, 24, 24));
  replaceByBlood(volume, lumen, 1);
  EXPECT_EQ(volume.at(10, 10, 10).tissue, propertiesOf(Tissue::kBlood).density);
  EXPECT_EQ(volume.at(10, 10, 10).bone, 0.0);
  EXPECT_EQ(volume.at(10, 10, 15).bone, 0.0);    // rim
  EXPECT_EQ(volume.at(10, 10, 17).bone, 200.0);  // beyond
  EXPECT_EQ(volume.at(2, 10, 10).tissue, 260.0);
}

}  // namespace
}  // namespace endovascular_sim::patient
