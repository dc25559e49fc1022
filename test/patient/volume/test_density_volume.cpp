#include "patient/volume/density_volume.h"

#include <gtest/gtest.h>

#include <limits>

#include "common/error.h"
#include "test/patient/volume_shapes.h"

namespace endovascular_sim::patient
{
namespace
{

TEST(DensityVolume, InterpolatesALinearFieldExactlyInARotatedLattice)
{
  image::VolumeGrid grid;
  grid.size = {11, 9, 7};
  grid.spacing = {1e-3, 2e-3, 3e-3};
  grid.origin = {0.1, -0.2, 0.3};
  grid.axes = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  DensityVolume volume(grid);
  for (int z = 0; z < 7; ++z)
    for (int y = 0; y < 9; ++y)
      for (int x = 0; x < 11; ++x)
        volume.set(x, y, z, {5.0 * (3 * x + 2 * y + z), 8.0 * (10 + x - y + z)});
  const Eigen::Vector3d c(3.3, 4.7, 2.1);
  const Density density = volume.interpolate(grid.position(c));
  EXPECT_NEAR(density.tissue, 5.0 * (3 * c.x() + 2 * c.y() + c.z()), 1e-9);
  EXPECT_NEAR(density.bone, 8.0 * (10 + c.x() - c.y() + c.z()), 1e-9);
  EXPECT_LT((grid.index(grid.position(c)) - c).norm(), 1e-9);
  EXPECT_EQ(volume.interpolate(grid.position({-0.1, 1.0, 1.0})).tissue, 0.0);
  EXPECT_EQ(volume.memory(), 2U * 11 * 9 * 7);
}

TEST(DensityVolume, StoresTheNearestStepAndLimitsDensitiesToItsRange)
{
  EXPECT_DOUBLE_EQ(DensityVolume::decode(DensityVolume::encode({1060.0, 1920.0})).tissue, 1060.0);
  EXPECT_DOUBLE_EQ(DensityVolume::decode(DensityVolume::encode({1062.6, 1916.1})).tissue, 1065.0);
  EXPECT_DOUBLE_EQ(DensityVolume::decode(DensityVolume::encode({0.0, 1916.1})).bone, 1920.0);
  EXPECT_DOUBLE_EQ(DensityVolume::decode(DensityVolume::encode({-7.0, 1e9})).tissue, 0.0);
  EXPECT_DOUBLE_EQ(DensityVolume::decode(DensityVolume::encode({-7.0, 1e9})).bone, 2040.0);
}

TEST(DensityVolume, RefusesGridsThatAreNoLattice)
{
  image::VolumeGrid grid = cubicGrid(4, 1e-3);
  grid.size.x() = 1;
  EXPECT_THROW(DensityVolume{grid}, InputError);
  grid = cubicGrid(2048, 1e-3);
  EXPECT_THROW(DensityVolume{grid}, InputError);  // 2^33 voxels
  grid = cubicGrid(4, 1.0);                       // millimetres
  EXPECT_THROW(DensityVolume{grid}, InputError);
  grid = cubicGrid(4, std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(DensityVolume{grid}, InputError);
  grid = cubicGrid(4, 1e-3);
  grid.axes(0, 2) = 0.1;
  EXPECT_THROW(DensityVolume{grid}, InputError);
}

}  // namespace
}  // namespace endovascular_sim::patient
