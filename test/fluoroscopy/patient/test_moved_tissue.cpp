#include "fluoroscopy/patient/moved_tissue.h"

#include <gtest/gtest.h>

#include "test/fluoroscopy/motion_fixtures.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

/** Volume of the moved body: every voxel has the density of its place at rest. */
patient::DensityVolume warped(const patient::DensityVolume& volume, const BodyMotion& motion)
{
  patient::DensityVolume moved(volume.grid());
  const Eigen::Vector3i size = volume.grid().size;
  for (int z = 0; z < size.z(); ++z)
    for (int y = 0; y < size.y(); ++y)
      for (int x = 0; x < size.x(); ++x)
        moved.set(x, y, z, volume.interpolate(motion.pullBack(volume.grid().position(Eigen::Vector3d(x, y, z)))));
  return moved;
}

class MovedTissueInViews : public testing::TestWithParam<std::pair<double, double>>
{
};

TEST_P(MovedTissueInViews, EqualsTheProjectionOfAnExplicitlyWarpedVolume)
{
  const patient::DensityVolume volume = smoothBody(120, 2.5e-3);
  const BodyMotion motion = largestMotion();
  const VolumeProjection rest(volume), moved(warped(volume, motion));
  const XRayGeometry geometry(heartView(GetParam().first, GetParam().second, 64));
  MovedTissue tissue(rest, motion.map().frame());
  const std::vector<float> wanted = difference(moved.project(geometry, 64).tissue, rest.project(geometry, 64).tissue);
  const std::vector<float> exact = tissue.change(geometry, 64, motion, MotionSampling::kExact);
  const std::vector<float> fast = tissue.change(geometry, 64, motion, MotionSampling::kFast);
  EXPECT_GT(rootMeanSquare(wanted), 3.0);
  EXPECT_LT(rootMeanSquare(difference(exact, wanted)), 0.02 * rootMeanSquare(wanted));
  EXPECT_LT(largestOf(difference(exact, wanted)), 0.03 * largestOf(wanted));
  EXPECT_LT(rootMeanSquare(difference(fast, exact)), 0.02 * rootMeanSquare(wanted));
  EXPECT_LT(largestOf(difference(fast, exact)), 0.05 * largestOf(wanted));
}

INSTANTIATE_TEST_SUITE_P(All, MovedTissueInViews,
                         testing::Values(std::pair{0.0, 0.0}, std::pair{-0.52, -0.35}, std::pair{1.5708, 0.0},
                                         std::pair{0.78, 0.5}));

TEST(MovedTissue, HasNoChangeAtRestNorWhereNothingMoves)
{
  const VolumeProjection rest(smoothBody(100, 3e-3));
  MovedTissue tissue(rest, motion::naturalHeart());
  const XRayGeometry geometry(heartView(0.0, 0.0, 64));
  EXPECT_LT(largestOf(tissue.change(geometry, 64, motionAt(0.0, 0.0), MotionSampling::kExact)), 1e-3);
  CArmPose beside = heartView(0.0, 0.0, 64);
  beside.isocentre.z() += 0.3;
  beside.detector_width = 0.1;
  EXPECT_EQ(largestOf(tissue.change(XRayGeometry(beside), 64, largestMotion(), MotionSampling::kExact)), 0.0);
}

TEST(MovedTissue, LeavesBonesAtRestWithoutAHoleThatMoves)
{
  // Bars of compact bone in uniform tissue: what moves is uniform.
  patient::DensityVolume volume(patient::cubicGrid(100, 3e-3, motion::naturalHeart().fade.centre));
  for (int z = 0; z < 100; ++z)
    for (int y = 0; y < 100; ++y)
      for (int x = 0; x < 100; ++x)
        volume.set(x, y, z, z / 6 % 2 == 0 ? patient::Density{1050.0, 0.0} : patient::Density{525.0, 960.0});
  MovedTissue tissue(VolumeProjection(volume), motion::naturalHeart());
  const XRayGeometry geometry(heartView(0.0, 0.0, 64));
  EXPECT_LT(largestOf(tissue.change(geometry, 64, largestMotion(), MotionSampling::kExact)), 0.3);
}

TEST(MovedTissue, MovesALongTheLatticeOfARotatedVolume)
{
  // The same body in a volume with other axes: its voxels differ, the image does not.
  const patient::DensityVolume volume = smoothBody(120, 2.5e-3);
  image::VolumeGrid grid = volume.grid();
  grid.axes.col(0) = Eigen::Vector3d::UnitY();
  grid.axes.col(1) = -Eigen::Vector3d::UnitX();
  grid.origin += 2.5e-3 * 119 * Eigen::Vector3d::UnitX();
  patient::DensityVolume turned(grid);
  for (int z = 0; z < 120; ++z)
    for (int y = 0; y < 120; ++y)
      for (int x = 0; x < 120; ++x)
        turned.set(x, y, z, volume.at(119 - y, x, z));
  const XRayGeometry geometry(heartView(-0.3, 0.2, 48));
  const BodyMotion motion = largestMotion();
  MovedTissue one(VolumeProjection(volume), motion.map().frame()),
      other(VolumeProjection(turned), motion.map().frame());
  for (const MotionSampling sampling : {MotionSampling::kExact, MotionSampling::kFast})
  {
    const std::vector<float> a = one.change(geometry, 48, motion, sampling);
    EXPECT_LT(largestOf(difference(a, other.change(geometry, 48, motion, sampling))), 0.01 * largestOf(a));
  }
}

TEST(MovedTissue, DoesNotDependOnTheChangeBefore)
{
  const VolumeProjection rest(smoothBody(100, 3e-3));
  MovedTissue used(rest, motion::naturalHeart()), fresh(rest, motion::naturalHeart());
  const XRayGeometry geometry(heartView(0.3, 0.1, 32)), other(heartView(-0.3, 0.1, 32));
  used.change(other, 32, motionAt(0.2, 0.2), MotionSampling::kFast);
  used.change(geometry, 16, motionAt(0.1, 0.3), MotionSampling::kExact);
  for (const MotionSampling sampling : {MotionSampling::kExact, MotionSampling::kFast})
    EXPECT_EQ(used.change(geometry, 32, largestMotion(), sampling),
              fresh.change(geometry, 32, largestMotion(), sampling));
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
