#include "fluoroscopy/patient/volume_projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/error.h"
#include "test/patient/volume_shapes.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

const patient::Density kTissueAndBone{1050.0, 800.0};

patient::DensityVolume shape(const image::VolumeGrid& grid,
                             const std::function<double(const Eigen::Vector3d&)>& distance)
{
  patient::DensityVolume volume(grid);
  patient::fillShape(volume, kTissueAndBone, distance);
  return volume;
}

/** Poses in all directions: along each axis, oblique, and near the change of the sampling axis at 45°. */
std::vector<CArmPose> poses(double width)
{
  std::vector<CArmPose> poses;
  for (const auto& [primary, secondary] : std::vector<std::pair<double, double>>{{0.0, 0.0},
                                                                                 {M_PI_2, 0.0},
                                                                                 {0.0, 0.6},
                                                                                 {M_PI_4 - 0.01, 0.0},
                                                                                 {M_PI_4 + 0.01, 0.3},
                                                                                 {-0.5, -0.35},
                                                                                 {1.0, 1.2}})
  {
    CArmPose pose;
    pose.primary_angle = primary;
    pose.secondary_angle = secondary;
    pose.detector_width = width;
    pose.isocentre = {0.003, -0.002, 0.001};
    poses.push_back(pose);
  }
  return poses;
}

/** Compares a projection with exact chords. Rays whose chord is shorter than @p rim are skipped.
 *  @param exact chord of a ray [m]: source, unit direction */
void expectChords(const VolumeProjection& projection, const CArmPose& pose, int samples, double rim,
                  const std::function<double(const Eigen::Vector3d&, const Eigen::Vector3d&)>& exact)
{
  const XRayGeometry geometry(pose);
  const ArealDensityImage image = projection.project(geometry, samples);
  int compared = 0;
  for (int row = 0; row < samples; ++row)
    for (int column = 0; column < samples; ++column)
    {
      const double scale = static_cast<double>(pose.pixels) / samples;
      const Eigen::Vector3d direction =
          geometry.axes() * geometry.ray((column + 0.5) * scale - 0.5, (row + 0.5) * scale - 0.5).normalized();
      const double chord = exact(geometry.source(), direction);
      if (chord < rim)
        continue;
      const auto at = static_cast<std::size_t>(row * samples + column);
      ASSERT_NEAR(image.tissue[at] / (kTissueAndBone.tissue * chord), 1.0, 0.01) << row << " " << column;
      ASSERT_NEAR(image.bone[at] / (kTissueAndBone.bone * chord), 1.0, 0.01) << row << " " << column;
      ++compared;
    }
  EXPECT_GT(compared, samples * samples / 20);
}

TEST(VolumeProjection, ProjectsASphereWithinOnePercentAwayFromItsRim)
{
  const Eigen::Vector3d centre(0.004, 0.001, -0.003);
  const double radius = 0.1;
  const VolumeProjection projection(
      shape(patient::cubicGrid(176, 1.25e-3), [&](const Eigen::Vector3d& p) { return (p - centre).norm() - radius; }));
  for (const CArmPose& pose : poses(0.36))
    expectChords(projection, pose, 64, radius,
                 [&](const Eigen::Vector3d& s, const Eigen::Vector3d& d)
                 { return 2.0 * std::sqrt(std::max(0.0, radius * radius - d.cross(centre - s).squaredNorm())); });
}

TEST(VolumeProjection, ProjectsACylinderWithinOnePercentAwayFromItsRim)
{
  const Eigen::Vector3d axis = Eigen::Vector3d(0.3, 0.2, 1.0).normalized();
  const double radius = 0.03;
  const VolumeProjection projection(
      shape(patient::cubicGrid(96, 1.25e-3), [&](const Eigen::Vector3d& p) { return axis.cross(p).norm() - radius; }));
  for (CArmPose pose : poses(0.04))
  {
    pose.isocentre.setZero();
    if (pose.secondary_angle > 0.5)
      continue;  // the ray leaves the cylinder through its ends
    expectChords(projection, pose, 32, radius,
                 [&](const Eigen::Vector3d& s, const Eigen::Vector3d& d)
                 {
                   const double distance = std::abs(s.dot(axis.cross(d))) / axis.cross(d).norm();
                   const double across = axis.cross(d).norm();
                   return 2.0 * std::sqrt(std::max(0.0, radius * radius - distance * distance)) / across;
                 });
  }
}

TEST(VolumeProjection, ProjectsASlabWithinOnePercent)
{
  const double thickness = 0.0613;  // no multiple of the spacing
  image::VolumeGrid grid = patient::cubicGrid(160, 1.0e-3);
  const VolumeProjection projection(
      shape(grid, [&](const Eigen::Vector3d& p) { return std::abs(p.y()) - 0.5 * thickness; }));
  for (CArmPose pose : poses(0.08))
  {
    if (std::abs(pose.primary_angle) > 0.6 || std::abs(pose.secondary_angle) > 0.5)
      continue;  // the slab does not fill the field
    expectChords(projection, pose, 48, 0.01,
                 [&](const Eigen::Vector3d&, const Eigen::Vector3d& d) { return thickness / std::abs(d.y()); });
  }
}

/** Reference: midpoint rule with 40 samples a voxel of the trilinear interpolation. */
patient::Density fineIntegral(const patient::DensityVolume& volume, const XRayGeometry& geometry, double column,
                              double row)
{
  const Eigen::Vector3d direction = geometry.axes() * geometry.ray(column, row);
  const double step = volume.grid().spacing.minCoeff() / 40.0 / direction.norm();
  const double radius = 0.87 * volume.grid().spacing.cwiseProduct(volume.grid().size.cast<double>()).norm();
  patient::Density sum;
  for (double t = std::max(0.0, 0.75 - radius); t < std::min(0.75 + radius, geometry.pose().source_to_detector);
       t += step)
  {
    const patient::Density density = volume.interpolate(geometry.source() + (t + 0.5 * step) * direction);
    sum.tissue += step * direction.norm() * density.tissue;
    sum.bone += step * direction.norm() * density.bone;
  }
  return sum;
}

TEST(VolumeProjection, EqualsFineIntegrationOfARandomVolumeInARotatedLattice)
{
  // White noise is the worst case: a patient is smooth on the scale of a voxel.
  image::VolumeGrid grid;
  grid.size = {40, 31, 23};
  grid.spacing = {1.0e-3, 1.3e-3, 1.9e-3};
  grid.axes = Eigen::AngleAxisd(0.4, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  grid.origin = grid.axes * Eigen::Vector3d(-0.02, -0.02, -0.02);
  patient::DensityVolume volume(grid);
  std::mt19937 random(5);
  for (std::uint16_t& voxel : volume.voxels())
    voxel = static_cast<std::uint16_t>(random());
  const VolumeProjection projection(volume);
  for (CArmPose pose : poses(0.05))
  {
    pose.pixels = 24;
    const XRayGeometry geometry(pose);
    const ArealDensityImage image = projection.project(geometry, 24);
    double error = 0.0, mean = 0.0, bias = 0.0;
    for (int row = 0; row < 24; ++row)
      for (int column = 0; column < 24; ++column)
      {
        const patient::Density exact = fineIntegral(volume, geometry, column, row);
        const auto at = static_cast<std::size_t>(row * 24 + column);
        error += std::pow(image.bone[at] - exact.bone, 2) + std::pow(image.tissue[at] - exact.tissue, 2);
        bias += image.bone[at] - exact.bone + image.tissue[at] - exact.tissue;
        mean += exact.bone + exact.tissue;
      }
    EXPECT_LT(std::sqrt(error / 1152.0) / (mean / 1152.0), 0.06) << pose.primary_angle << " " << pose.secondary_angle;
    EXPECT_LT(std::abs(bias) / mean, 0.005);
  }
}

TEST(VolumeProjection, HasNoStepsWhereRaysEnterThroughTheSideOfAFilledVolume)
{
  // A patient fills the volume to its cut ends. Rays through such an end have a chord that is linear in the row.
  image::VolumeGrid grid = patient::cubicGrid(80, 1.25e-3);
  const VolumeProjection projection(shape(grid, [](const Eigen::Vector3d&) { return -1.0; }));
  CArmPose pose;
  pose.secondary_angle = 0.5;
  pose.detector_width = 0.05;
  pose.isocentre = grid.position(Eigen::Vector3d(39.5, 39.5, 79.0));
  pose.pixels = 512;
  const ArealDensityImage image = projection.project(XRayGeometry(pose), 512);
  double largest = 0.0;
  for (std::size_t row = 101; row < 411; ++row)
  {
    const auto at = [&](std::size_t k) { return static_cast<double>(image.tissue[512 * k + 256]); };
    largest = std::max(largest, std::abs(at(row + 1) - 2.0 * at(row) + at(row - 1)));
  }
  EXPECT_LT(largest, 2e-4 * 1050.0 * 0.05);
}

TEST(VolumeProjection, ProjectsOnlyBetweenSourceAndDetector)
{
  const VolumeProjection projection(shape(patient::cubicGrid(64, 0.01), [](const Eigen::Vector3d&) { return -1.0; }));
  CArmPose pose;
  pose.source_to_patient = 0.2;
  pose.source_to_detector = 0.25;
  pose.detector_width = 0.01;
  EXPECT_NEAR(projection.project(XRayGeometry(pose), 1).tissue[0], 1050.0 * 0.25, 0.01 * 1050.0 * 0.25);
  pose.isocentre = {2.0, 0.0, 0.0};
  EXPECT_EQ(projection.project(XRayGeometry(pose), 1).tissue[0], 0.0F);
}

TEST(VolumeProjection, AnEmptyVolumeIsAir)
{
  const VolumeProjection projection(patient::DensityVolume(patient::cubicGrid(8, 0.01)));
  EXPECT_EQ(projection.project(XRayGeometry(CArmPose()), 4).tissue, std::vector<float>(16, 0.0F));
}

TEST(VolumeProjection, RowsEqualThoseOfTheWholeImage)
{
  const VolumeProjection projection(
      shape(patient::cubicGrid(40, 2e-3), [](const Eigen::Vector3d& p) { return p.norm() - 0.03; }));
  const XRayGeometry geometry(poses(0.1)[5]);
  const ArealDensityImage whole = projection.project(geometry, 30);
  ArealDensityImage parts = emptyImage(30);
  projection.projectRows(geometry, 17, 30, parts);
  projection.projectRows(geometry, 0, 17, parts);
  EXPECT_EQ(parts.tissue, whole.tissue);
  EXPECT_EQ(parts.bone, whole.bone);
}

TEST(ArealDensityImage, IsResampledLinearly)
{
  ArealDensityImage image = emptyImage(4);
  for (std::size_t i = 0; i < 16; ++i)
    image.tissue[i] = static_cast<float>(i % 4) + 10.0F * static_cast<float>(i / 4);
  const ArealDensityImage fine = resampled(image, 8);
  EXPECT_FLOAT_EQ(fine.tissue[8 * 3 + 4], 1.75F + 12.5F);
  EXPECT_FLOAT_EQ(fine.tissue[0], 0.0F);
  EXPECT_FLOAT_EQ(fine.tissue[63], 33.0F);
  EXPECT_THROW(emptyImage(0), InputError);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
