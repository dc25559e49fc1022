#include "segmentation/labels/mask_field.h"

#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "segmentation/labels/field_surface.h"
#include "segmentation/surface/lumen_surface.h"
#include "test/segmentation/label_maps.h"

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kVoxel = 1e-3;  // m

/** Tube across a box, and the grid that samples it. */
struct Case
{
  double diameter;        // voxels
  double tallest;         // spacing along z, in voxels
  Eigen::Vector3d along;  // direction of the axis
};

/** Errors of the surface of a mask, in voxels. */
struct Errors
{
  double bias = 0.0;  // of the radius
  double p95 = 0.0;
  double steepest = 0.0;  // rms angle between facets and the wall [rad]
  int genus = 0;
};

Errors errorsOf(const Case& tube)
{
  const double radius = 0.5 * tube.diameter * kVoxel;
  const double width = 2.0 * radius + 24.0 * kVoxel;
  const Eigen::Vector3d spacing(kVoxel, kVoxel, tube.tallest * kVoxel);
  const Eigen::Vector3i size = Eigen::Vector3d::Constant(width).cwiseQuotient(spacing).array().ceil().cast<int>();
  const Eigen::Vector3d centre =
      0.5 * size.cast<double>().cwiseProduct(spacing) + kVoxel * Eigen::Vector3d(0.2, 0.37, 0.11);
  const Eigen::Vector3d along = tube.along.normalized();
  const ExactTube exact{{centre - 0.35 * width * along, centre + 0.35 * width * along}, radius};
  const VoxelMask mask = maskOf(labelMapOf({exact}, size, spacing, Eigen::Vector3d::Zero()), 2);
  const geometry::TriangleMesh mesh = fieldSurface(mask, smoothField(mask));
  Errors errors;
  errors.genus = genusOf(mesh);
  std::vector<std::pair<double, double>> distances;  // and areas
  double area = 0.0;
  double turn = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles)
  {
    const auto at = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    const Eigen::Vector3d middle = (at(0) + at(1) + at(2)) / 3.0;
    if (std::abs((middle - centre).dot(along)) > 0.35 * width - radius)  // the ends
      continue;
    const Eigen::Vector3d normal = 0.5 * (at(1) - at(0)).cross(at(2) - at(0));
    const Eigen::Vector3d out = middle - centre - (middle - centre).dot(along) * along;
    const double error = (out.norm() - radius) / kVoxel;
    distances.emplace_back(std::abs(error), normal.norm());
    errors.bias += error * normal.norm();
    turn += std::pow(std::acos(std::clamp(normal.dot(out) / normal.norm() / out.norm(), -1.0, 1.0)), 2) * normal.norm();
    area += normal.norm();
  }
  errors.bias /= area;
  errors.steepest = std::sqrt(turn / area);
  std::sort(distances.begin(), distances.end());
  double passed = 0.0;
  for (const auto& [distance, own] : distances)
    if ((passed += own) <= 0.95 * area)
      errors.p95 = distance;
  return errors;
}

TEST(MaskField, HasTheSurfaceOfATubeWithinHalfAVoxelAndWithoutBias)
{
  for (const double diameter : {4.0, 6.0, 10.0, 20.0})
    for (const Eigen::Vector3d& along : {Eigen::Vector3d(0.0, 0.0, 1.0), Eigen::Vector3d(0.1, 0.05, 1.0),
                                         Eigen::Vector3d(1.0, 0.7, 0.4), Eigen::Vector3d(1.0, 0.13, 0.06)})
      for (const double tallest : {1.0, 2.0})
      {
        const Errors errors = errorsOf({diameter, tallest, along});
        std::printf(
            "diameter %2.0f, spacing 1:%g, along (%g %g %g): diameter %+.3f, 95 %% %.3f voxels, rms angle %.1f\n",
            diameter, tallest, along.x(), along.y(), along.z(), 2.0 * errors.bias, errors.p95,
            errors.steepest * 180.0 / M_PI);
        EXPECT_EQ(errors.genus, 0);
        EXPECT_LE(errors.p95, 0.5 * tallest);
        EXPECT_LE(std::abs(2.0 * errors.bias), 0.25);
      }
}

TEST(MaskField, EnclosesTheVolumeOfTheMask)
{
  const ExactTube tube{{{0.01, 0.012, 0.008}, {0.022, 0.018, 0.032}}, 0.0025};
  const VoxelMask mask =
      maskOf(labelMapOf({tube}, {40, 40, 40}, Eigen::Vector3d::Constant(1e-3), Eigen::Vector3d::Zero()), 2);
  const geometry::TriangleMesh mesh = fieldSurface(mask, smoothField(mask));
  EXPECT_NEAR(mesh.signedVolume() / (static_cast<double>(mask.voxels()) * mask.voxelVolume()), 1.0, 0.02);
}

TEST(MaskField, WithImposedSignsSeparatesTheVoxels)
{
  const ExactTube tube{{{0.01, 0.012, 0.008}, {0.022, 0.018, 0.032}}, 0.0012};
  VoxelMask mask =
      maskOf(labelMapOf({tube}, {40, 40, 40}, Eigen::Vector3d::Constant(1e-3), Eigen::Vector3d::Zero()), 2);
  mask.inside[mask.offset({20, 20, 20})] ^= 1U;
  std::vector<float> field = smoothField(mask);
  imposeSigns(mask, field);
  for (std::size_t n = 0; n < field.size(); ++n)
    EXPECT_EQ(field[n] < 0.0F, mask.inside[n] != 0);
}

}  // namespace
}  // namespace endovascular_sim::segmentation
