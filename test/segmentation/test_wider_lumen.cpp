#include "segmentation/wider_lumen.h"

#include <cstdio>

#include <gtest/gtest.h>

#include "test/common/input_error_of.h"
#include "test/segmentation/diseased_accuracy.h"

namespace endovascular_sim::segmentation
{
namespace
{

class AnAneurysm : public ::testing::TestWithParam<double>
{
};

TEST_P(AnAneurysm, IsSegmentedUpToItsWall)
{
  const auto vessel = phantom::diseasedVessel("aneurysm", GetParam());
  const Scan scan(phantom::imageOf(*vessel, vessel->usualImage()));
  const Segmentation result =
      segmentBranches(scan, clicksInto(*vessel), edgeSettings(scan.modality(), scan.spacing()), 0);
  const DiseasedAccuracy accuracy = accuracyOf(*vessel, scan, result.branches[0]);
  accuracy.print("aneurysm");
  EXPECT_LE(accuracy.p95, 1.5e-4);
  EXPECT_LE(accuracy.back, 1.5e-4);
  EXPECT_LE(std::max(accuracy.largest, accuracy.farthest), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Diameters, AnAneurysm, ::testing::Values(0.035, 0.045, 0.06),
                         [](const auto& info) { return std::to_string(std::lround(1e3 * info.param)) + "mm"; });

TEST(AWiderLumen, ThanTheClicksAllowIsRefusedWithTheRemedy)
{
  const auto vessel = phantom::diseasedVessel("aneurysm", 0.06);
  const Scan scan(phantom::imageOf(*vessel, vessel->usualImage()));
  const EdgeSettings settings = edgeSettings(scan.modality(), scan.spacing());
  const std::string error = inputErrorOf([&] { segmentBranches(scan, clicksInto(*vessel, 0.022), settings, 0); });
  EXPECT_NE(error.find("vessel: has no edge of the lumen along"), std::string::npos) << error;
  EXPECT_NE(error.find("raise largest_radius"), std::string::npos) << error;
}

TEST(AWiderLumen, ThatTheImageCutsOffIsRefused)
{
  const auto vessel = phantom::diseasedVessel("aneurysm", 0.06);
  phantom::PhantomSettings settings = vessel->usualImage();
  settings.grid = phantom::gridOfBox({-0.024, -0.024, -0.07}, {0.024, 0.024, 0.07}, settings.grid.spacing);
  const Scan scan(phantom::imageOf(*vessel, settings));
  const std::string error = inputErrorOf(
      [&] { segmentBranches(scan, clicksInto(*vessel), edgeSettings(scan.modality(), scan.spacing()), 0); });
  EXPECT_NE(error.find("has no edge of the lumen along"), std::string::npos) << error;
}

}  // namespace
}  // namespace endovascular_sim::segmentation
