#include "segmentation/lumen/wide_regions.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::segmentation
{
namespace
{

TEST(SquaredDistances, AreThoseOfBruteForce)
{
  const Eigen::Vector3i size(13, 9, 11);
  const Eigen::Vector3d spacing(1.0, 1.5, 0.7);
  std::vector<float> squared(static_cast<std::size_t>(size.prod()), 1e6F);
  std::vector<Eigen::Vector3d> marked;
  const auto place = [&](int i, int j, int k) { return static_cast<std::size_t>((k * size.y() + j) * size.x() + i); };
  for (const Eigen::Vector3i& m : {Eigen::Vector3i(1, 2, 3), Eigen::Vector3i(10, 8, 0), Eigen::Vector3i(6, 0, 10)})
  {
    squared[place(m.x(), m.y(), m.z())] = 0.0F;
    marked.push_back(m.cast<double>().cwiseProduct(spacing));
  }
  squaredDistances(squared, size, spacing);
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i)
      {
        double least = 1e30;
        for (const Eigen::Vector3d& m : marked)
          least = std::min(least, (Eigen::Vector3d(i, j, k).cwiseProduct(spacing) - m).squaredNorm());
        EXPECT_NEAR(squared[place(i, j, k)], least, 1e-4);
      }
}

TEST(WideRegions, AreBallsButNotThinTubes)
{
  image::Volume volume;
  volume.grid.size = {60, 60, 60};
  volume.grid.spacing.setConstant(5e-4);
  volume.stored.assign(volume.grid.voxels(), 0);
  for (int k = 0; k < 60; ++k)
    for (int j = 0; j < 60; ++j)
      for (int i = 0; i < 60; ++i)
      {
        const Eigen::Vector3d p = 5e-4 * Eigen::Vector3d(i, j, k);
        const bool ball = (p - Eigen::Vector3d(0.015, 0.015, 0.012)).norm() < 0.008;
        const bool tube = std::hypot(p.x() - 0.015, p.y() - 0.015) < 0.002;
        volume.stored[volume.grid.offset(i, j, k)] = ball || tube ? 400 : 0;
      }
  const Scan scan(volume);
  const WideRegions wide(scan, 200.0, 0.004);
  EXPECT_TRUE(wide.contains({0.015, 0.015, 0.012}));
  EXPECT_TRUE(wide.contains({0.020, 0.015, 0.012}));
  EXPECT_FALSE(wide.contains({0.015, 0.015, 0.025}));
  EXPECT_FALSE(wide.contains({0.026, 0.015, 0.012}));
}

}  // namespace
}  // namespace endovascular_sim::segmentation
