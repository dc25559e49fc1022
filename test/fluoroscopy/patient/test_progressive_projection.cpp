#include "fluoroscopy/patient/progressive_projection.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "common/error.h"
#include "fluoroscopy/motion/phase_grid.h"
#include "test/fluoroscopy/motion_fixtures.h"

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
    EXPECT_FALSE(progressive.isComplete());
    EXPECT_EQ(progressive.revision(), 1);
  }
  EXPECT_EQ(progressive.frame(geometry).tissue, fine.tissue);
  EXPECT_TRUE(progressive.isComplete());
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
  EXPECT_TRUE(still.isComplete());
  still.frame(geometry);
  EXPECT_EQ(still.revision(), 1);  // the image is kept
  other.frame(geometry);
  EXPECT_EQ(first.tissue, other.frame(geometry).tissue);
  EXPECT_EQ(first.bone, other.frame(geometry).bone);
}

TEST(ProgressiveProjection, AtAPhaseOfRestHasTheBitsOfAPatientWhoDoesNotMove)
{
  const auto projection = std::make_shared<const VolumeProjection>(smoothBody(80, 3e-3));
  ProgressiveProjection moving(projection, {16, 32, 256}), resting(projection, {16, 32, 256});
  const XRayGeometry geometry(heartView(0.2, 0.1, 64));
  for (int frame = 0; frame < 6; ++frame)
  {
    moving.setMotion(motionAt(0.0, 0.0));
    EXPECT_EQ(moving.frame(geometry).tissue, resting.frame(geometry).tissue) << frame;
    EXPECT_EQ(moving.revision(), resting.revision()) << frame;
  }
  moving.setMotion(largestMotion());
  EXPECT_NE(moving.frame(geometry).tissue, resting.frame(geometry).tissue);
  moving.setMotion(BodyMotion());
  EXPECT_EQ(moving.frame(geometry).tissue, resting.frame(geometry).tissue);
  EXPECT_EQ(moving.frame(geometry).bone, resting.frame(geometry).bone);
}

TEST(ProgressiveProjection, AddsTheChangeOfTheMotionAtTheFirstResolution)
{
  const auto projection = std::make_shared<const VolumeProjection>(smoothBody(80, 3e-3));
  ProgressiveProjection moving(projection, {16, 32, 1 << 20, MotionSampling::kExact});
  const XRayGeometry geometry(heartView(0.2, 0.1, 64));
  MovedTissue tissue(*projection, motion::naturalHeart());
  std::vector<float> wanted = resampled(projection->project(geometry, 32), 64).tissue;
  addResampled(tissue.change(geometry, 16, largestMotion(), MotionSampling::kExact), 16, 64, wanted);
  moving.setMotion(motionAt(0.3, 0.2));
  moving.frame(geometry);
  moving.setMotion(largestMotion());
  const int before = moving.revision();
  EXPECT_EQ(moving.frame(geometry).tissue, wanted);
  EXPECT_EQ(moving.revision(), before + 1);
  EXPECT_EQ(moving.frame(geometry).tissue, wanted);
  EXPECT_EQ(moving.revision(), before + 1);
}

TEST(ProgressiveProjection, CompletesTheImageAtOnceOnRequest)
{
  const patient::DensityVolume volume = ball();
  ProgressiveProjection progressive(volume, {16, 32, 256}), still(volume, {32, 32, 256});
  const XRayGeometry geometry(pose(0.3));
  const ArealDensityImage fine = resampled(VolumeProjection(volume).project(geometry, 32), 64);
  progressive.complete(geometry);  // before the first frame
  EXPECT_EQ(progressive.frame(geometry).tissue, fine.tissue);
  EXPECT_TRUE(progressive.isComplete());
  EXPECT_EQ(progressive.revision(), 1);
  const XRayGeometry other(pose(0.4));
  progressive.frame(other);
  progressive.frame(other);
  progressive.complete(other);  // half way
  EXPECT_EQ(progressive.frame(other).tissue, resampled(VolumeProjection(volume).project(other, 32), 64).tissue);
  still.complete(geometry);
  EXPECT_EQ(still.frame(geometry).tissue, fine.tissue);
}

TEST(ProgressiveProjection, DoesNotDependOnTheFramesBefore)
{
  const auto projection = std::make_shared<const VolumeProjection>(smoothBody(80, 3e-3));
  const PhaseGrid grid({motion::naturalHeart(), motion::adultMotion()});
  ProgressiveProjection whole(projection, {32, 32, 1 << 20}), sparse(projection, {32, 32, 1 << 20});
  const XRayGeometry geometry(heartView(0.2, 0.1, 64));
  for (int frame = 0; frame < 30; ++frame)
  {
    const BodyMotion motion = grid.nearest(motionAt(std::fmod(frame * 0.0789, 1.0), std::fmod(frame * 0.0164, 1.0)));
    whole.setMotion(motion);
    const std::vector<float> tissue = whole.frame(geometry).tissue;
    if (frame % 3 != 0)
      continue;
    sparse.setMotion(motion);
    ASSERT_EQ(sparse.frame(geometry).tissue, tissue) << frame;
  }
}

TEST(ProgressiveProjection, TakesTheChangeOfAnEarlierFrameAtTheSamePhase)
{
  const auto projection = std::make_shared<const VolumeProjection>(smoothBody(100, 2.5e-3));
  const PhaseGrid grid({motion::naturalHeart(), motion::adultMotion()});
  ProgressiveProjection moving(projection, {64, 64, 1 << 20});
  const XRayGeometry geometry(heartView(0.2, 0.1, 64));
  MovedTissue tissue(*projection, motion::naturalHeart());
  const std::vector<float> still = projection->project(geometry, 64).tissue;
  double error = 0.0, change = 0.0;
  for (int frame = 0; frame < 240; ++frame)  // sixteen seconds; heart and breath repeat after twelve
  {
    const BodyMotion motion = motionAt(std::fmod(frame / 15.0 * 70.0 / 60.0, 1.0), std::fmod(frame / 60.0, 1.0));
    moving.setMotion(grid.nearest(motion));
    std::vector<float> wanted = still;
    if (!motion.resting())
      addResampled(tissue.change(geometry, 64, motion, MotionSampling::kExact), 64, 64, wanted);
    error = std::max(error, rootMeanSquare(difference(moving.frame(geometry).tissue, wanted)));
    change = std::max(change, rootMeanSquare(difference(wanted, still)));
  }
  EXPECT_GT(moving.reusedFrames(), 10U);
  EXPECT_GT(moving.movedFrames(), moving.reusedFrames());
  EXPECT_GT(change, 5.0);
  EXPECT_LT(error, 0.05 * change);
  std::printf("%d of %d frames from an earlier phase; RMS error up to %.3g kg/m², of changes up to %.3g\n",
              static_cast<int>(moving.reusedFrames()), static_cast<int>(moving.movedFrames()), error, change);
  CArmPose turned = geometry.pose();
  turned.primary_angle += 0.1;
  const auto reused = moving.reusedFrames();
  moving.frame(XRayGeometry(turned));
  EXPECT_EQ(moving.reusedFrames(), reused);  // another pose
}

TEST(ProgressiveProjection, WithExactMotionDoesNotDependOnEarlierPhases)
{
  const auto projection = std::make_shared<const VolumeProjection>(smoothBody(80, 3e-3));
  const ProgressiveResolution still{32, 32, 1 << 20, MotionSampling::kExact};
  ProgressiveProjection used(projection, still), fresh(projection, still);
  const XRayGeometry geometry(heartView(0.2, 0.1, 64));
  used.setMotion(motionAt(0.2, 0.2));
  used.frame(geometry);
  used.setMotion(motionAt(0.2001, 0.2));
  fresh.setMotion(motionAt(0.2001, 0.2));
  EXPECT_EQ(used.frame(geometry).tissue, fresh.frame(geometry).tissue);
  EXPECT_EQ(used.reusedFrames(), 0U);
}

TEST(ProgressiveProjection, RefusesResolutionsWithoutRays)
{
  EXPECT_THROW(ProgressiveProjection(ball(), {0, 32, 256}), InputError);
  EXPECT_THROW(ProgressiveProjection(ball(), {16, 0, 256}), InputError);
  EXPECT_THROW(ProgressiveProjection(ball(), {16, 32, 0}), InputError);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
