#include "fluoroscopy/patient/progressive_projection.h"

#include <gtest/gtest.h>

#include "common/error.h"
#include "test/patient/volume_shapes.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

patient::DensityVolume ball()
{
  patient::DensityVolume volume(patient::cubicGrid(40, 2e-3));
  patient::fillShape(volume, {1050.0, 400.0}, [](const Eigen::Vector3d& p) { return p.norm() - 0.03; });
  return volume;
}

CArmPose pose(double primary_angle)
{
  CArmPose pose;
  pose.primary_angle = primary_angle;
  pose.detector_width = 0.15;
  pose.pixels = 64;
  return pose;
}

TEST(ProgressiveProjection, IsCoarseAfterAMovementAndFinalAfterAFixedNumberOfFrames)
{
  const patient::DensityVolume volume = ball();
  ProgressiveProjection progressive(volume, {16, 32, 256});
  const XRayGeometry geometry(pose(0.3));
  const VolumeProjection projection(volume);
  const ArealDensityImage coarse = resampled(projection.project(geometry, 16), 64);
  const ArealDensityImage fine = resampled(projection.project(geometry, 32), 64);
  for (int frame = 0; frame < 4; ++frame)
  {
    EXPECT_EQ(progressive.frame(geometry).tissue, coarse.tissue) << frame;
    EXPECT_FALSE(progressive.isFinal());
    EXPECT_EQ(progressive.revision(), 1);
  }
  EXPECT_EQ(progressive.frame(geometry).tissue, fine.tissue);
  EXPECT_TRUE(progressive.isFinal());
  EXPECT_EQ(progressive.revision(), 2);
  EXPECT_EQ(progressive.frame(geometry).bone, fine.bone);
  EXPECT_EQ(progressive.revision(), 2);
}

TEST(ProgressiveProjection, AtRestTheImageDoesNotDependOnEarlierMovements)
{
  const patient::DensityVolume volume = ball();
  ProgressiveProjection moved(volume, {16, 32, 256}), fresh(volume, {16, 32, 256});
  for (int frame = 0; frame < 7; ++frame)
    moved.frame(XRayGeometry(pose(0.1 * frame)));
  const XRayGeometry geometry(pose(0.25));
  for (int frame = 0; frame < 6; ++frame)
  {
    moved.frame(geometry);
    fresh.frame(geometry);
  }
  EXPECT_EQ(moved.frame(geometry).tissue, fresh.frame(geometry).tissue);
  EXPECT_EQ(moved.frame(geometry).bone, fresh.frame(geometry).bone);
}

TEST(ProgressiveProjection, IsFinalInItsFirstFrameWhereNothingIsToBeRefined)
{
  const auto projection = std::make_shared<const VolumeProjection>(ball());
  ProgressiveProjection still(projection, {32, 32, 1 << 20}), other(projection, {16, 32, 1 << 20});
  const XRayGeometry geometry(pose(0.3));
  const ArealDensityImage first = still.frame(geometry);
  EXPECT_TRUE(still.isFinal());
  still.frame(geometry);
  EXPECT_EQ(still.revision(), 1);  // the image is kept
  other.frame(geometry);
  EXPECT_EQ(first.tissue, other.frame(geometry).tissue);
  EXPECT_EQ(first.bone, other.frame(geometry).bone);
}

TEST(ProgressiveProjection, RefusesResolutionsWithoutRays)
{
  EXPECT_THROW(ProgressiveProjection(ball(), {0, 32, 256}), InputError);
  EXPECT_THROW(ProgressiveProjection(ball(), {16, 0, 256}), InputError);
  EXPECT_THROW(ProgressiveProjection(ball(), {16, 32, 0}), InputError);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
