#include "segmentation/lumen/click_check.h"

#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "test/common/input_error_of.h"

namespace endovascular_sim::segmentation
{
namespace
{

// Millimetres.
constexpr double kVoxel = 0.5;
constexpr double kRadius = 2.0;
constexpr double kWall = 1.0;

/** CT of two straight vessels along z at x = 10 and x = 20 mm in fat, with bone at x < 4 and air at x > 26 mm. */
image::Volume scanOfTwoVessels()
{
  image::Volume volume;
  volume.grid.size = {61, 41, 61};
  volume.grid.spacing.setConstant(1e-3 * kVoxel);
  volume.grid.origin = {-0.1, 0.2, 0.3};
  for (int k = 0; k < 61; ++k)
    for (int j = 0; j < 41; ++j)
      for (int i = 0; i < 61; ++i)
      {
        const Eigen::Vector3d p = kVoxel * Eigen::Vector3d(i, j, k);
        double value = p.x() < 4.0 ? 900.0 : p.x() > 26.0 ? -900.0 : -90.0;
        for (const double x : {10.0, 20.0})
        {
          const double off_axis = std::hypot(p.x() - x, p.y() - 10.0);
          if (off_axis < kRadius + kWall)
            value = off_axis < kRadius ? 400.0 : 60.0;
        }
        volume.stored.push_back(static_cast<std::int16_t>(value));
      }
  return volume;
}

/** Clicks into the first vessel, the first one at a place of the caller [mm]. */
ClickSet clicksAt(const Eigen::Vector3d& first)
{
  const Eigen::Vector3d origin(-0.1, 0.2, 0.3);
  ClickSet set;
  set.file = "clicks.yaml";
  set.branches.push_back(
      {"artery", {{origin + 1e-3 * first, "line 6"}, {origin + 1e-3 * Eigen::Vector3d(10, 10, 25), "line 6"}}, 0.0});
  return set;
}

std::string errorAt(const Eigen::Vector3d& first)
{
  const Scan scan(scanOfTwoVessels());
  std::vector<std::string> warnings;
  return inputErrorOf([&] { checkClicks(scan, clicksAt(first), warnings); });
}

/** Distance of the proposed place from the axis of the first vessel [mm]; NaN without a proposal. */
double proposedOffAxis(const std::string& error)
{
  const std::string before = "the nearest lumen is at (";
  const std::size_t at = error.find(before);
  Eigen::Vector3d p;
  if (at == std::string::npos ||
      std::sscanf(error.c_str() + at + before.size(), "%lf, %lf, %lf", &p.x(), &p.y(), &p.z()) != 3)
    return std::nan("");
  return std::hypot(p.x() + 100.0 - 10.0, p.y() - 200.0 - 10.0);
}

class WrongClick : public ::testing::TestWithParam<std::pair<const char*, Eigen::Vector3d>>
{
};

TEST_P(WrongClick, IsRefusedWithItsPlaceItsTissueAndTheNearestLumen)
{
  const auto& [tissue, place] = GetParam();
  const std::string error = errorAt(place);
  EXPECT_NE(error.find("clicks.yaml: artery, click 1 (line 6) at ("), std::string::npos) << error;
  EXPECT_NE(error.find(tissue), std::string::npos) << error;
  EXPECT_LT(proposedOffAxis(error), kRadius) << error;
}

INSTANTIATE_TEST_SUITE_P(
    Tissues, WrongClick,
    ::testing::Values(std::pair("lies in fat", Eigen::Vector3d(10.0, 14.5, 10.0)),
                      std::pair("lies in soft tissue or the wall", Eigen::Vector3d(10.0, 12.5, 10.0)),
                      std::pair("lies in bone, calcium or metal", Eigen::Vector3d(2.0, 10.0, 10.0))));

TEST(ClickCheck, RefusesAClickIntoAir)
{
  const std::string error = errorAt({28.0, 10.0, 10.0});
  EXPECT_NE(error.find("lies in air or lung (-900 HU)"), std::string::npos) << error;
  EXPECT_NE(error.find("the nearest lumen is at ("), std::string::npos) << error;
}

TEST(ClickCheck, SaysWhereNoLumenIsNear)
{
  const std::string error = errorAt({29.5, 0.5, 1.0});
  EXPECT_NE(error.find("there is no lumen within 10 mm: click again"), std::string::npos) << error;
}

TEST(ClickCheck, RefusesAClickOutsideOfTheImageWithItsExtent)
{
  const std::string error = errorAt({10.0, 10.0, -5.0});
  EXPECT_NE(error.find("lies outside of the image, which extends from (-100, 200, 300) to (-70, 220, 330) mm"),
            std::string::npos)
      << error;
}

TEST(ClickCheck, AcceptsClicksIntoTheLumen)
{
  EXPECT_EQ(errorAt({11.0, 10.5, 3.0}), "");
}

}  // namespace
}  // namespace endovascular_sim::segmentation
