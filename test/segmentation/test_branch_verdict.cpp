#include "segmentation/branch_verdict.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "segmentation/segmentation_report.h"
#include "test/segmentation/diseased_accuracy.h"

namespace endovascular_sim::segmentation
{
namespace
{

class AThroat : public ::testing::TestWithParam<double>
{
};

TEST_P(AThroat, OfEightyPerCentIsReportedWithItsExpectedErrorWhateverTheNoise)
{
  const auto vessel = phantom::diseasedVessel("stenosis", 0.8);
  phantom::PhantomSettings settings = vessel->usualImage();
  settings.noise = GetParam();
  const Scan scan(phantom::imageOf(*vessel, settings));
  const Segmentation result =
      segmentBranches(scan, clicksInto(*vessel), edgeSettings(scan.modality(), scan.spacing()), 0);
  const DiseasedAccuracy accuracy = accuracyOf(*vessel, scan, result.branches[0]);
  accuracy.print("stenosis");
  EXPECT_LT(std::max(accuracy.p95, accuracy.back), 1.55e-4);  // 0.15 mm
  const Throat throat = throatOf(scan, result.branches[0]);
  std::printf("  throat of %.3f ± %.3f mm\n", 1e3 * throat.diameter, 1e3 * throat.error);
  EXPECT_NEAR(throat.diameter, 6e-4, throat.error);
  EXPECT_EQ(throatWarnings(scan, result.branches).size(), 1u);
  const BranchVerdict verdict = verdictOf(scan, result.branches, 0, result.warnings);
  EXPECT_NE(verdict.use, Use::kUse);
  const std::string text = segmentationText(scan, result.branches, result.warnings);
  EXPECT_NE(text.find("\nvessel: "), std::string::npos) << text;
  EXPECT_NE(text.find("voxels wide"), std::string::npos) << text;
}

INSTANTIATE_TEST_SUITE_P(Noise, AThroat, ::testing::Values(15.0, 25.0, 40.0),
                         [](const auto& info) { return std::to_string(std::lround(info.param)) + "HU"; });

/** Straight tube of 4 mm whose rays have all found the wall. */
LumenBranch tube(int sections)
{
  LumenBranch branch;
  branch.name = "tube";
  branch.largest_radius = 4e-3;
  for (int k = 0; k < sections; ++k)
  {
    Section section;
    section.centre = {0.01, 0.01, 5e-4 * k};
    section.radii.fill(2e-3);
    section.ends.fill(RayEnd::kWall);
    section.reach = 4e-3;
    section.blur = 4e-4;
    branch.sections.push_back(section);
  }
  return branch;
}

Scan emptyScan()
{
  image::Volume volume;
  volume.grid = phantom::gridOfBox({0.0, 0.0, 0.0}, {0.02, 0.02, 0.03}, Eigen::Vector3d::Constant(5e-4));
  volume.stored.assign(volume.grid.voxels(), 0);
  return Scan(std::move(volume));
}

TEST(BranchVerdict, NamesThePlaceAndTheReason)
{
  const Scan scan = emptyScan();
  std::vector<LumenBranch> branches = {tube(60)};
  EXPECT_EQ(nameOf(verdictOf(scan, branches, 0, {}).use), "use");
  EXPECT_EQ(nameOf(verdictOf(scan, branches, 0, {"other: stays closed"}).use), "use");
  const BranchVerdict warned = verdictOf(scan, branches, 0, {"tube: metal at 3 mm; use another image"});
  EXPECT_EQ(nameOf(warned.use), "look");
  EXPECT_EQ(warned.reasons, std::vector<std::string>{"metal at 3 mm"});

  for (const auto& [rays, expected] : {std::pair(9, "use"), std::pair(14, "look"), std::pair(24, "do not use")})
  {
    branches = {tube(60)};
    for (std::size_t k = 20; k < 40; ++k)
      for (int ray = 0; ray < rays; ++ray)
        branches[0].sections[k].ends[static_cast<std::size_t>(ray)] = RayEnd::kOpen;
    EXPECT_EQ(nameOf(verdictOf(scan, branches, 0, {}).use), expected) << rays;
  }
  branches = {tube(60)};
  for (std::size_t k = 20; k < 40; ++k)
    std::fill_n(branches[0].sections[k].ends.begin(), 20, RayEnd::kCalcium);
  const BranchVerdict calcified = verdictOf(scan, branches, 0, {});
  EXPECT_EQ(nameOf(calcified.use), "look");
  EXPECT_NE(calcified.reasons.at(0).find("calcium at 1"), std::string::npos) << calcified.reasons[0];
}

TEST(BranchVerdict, TakesNoRayIntoAnotherBranchForDoubtful)
{
  const Scan scan = emptyScan();
  std::vector<LumenBranch> branches = {tube(60), tube(60)};
  branches[1].name = "other";
  for (Section& section : branches[1].sections)  // beside the first one, along u
    section.centre.x() += 4e-3;
  for (std::size_t k = 20; k < 40; ++k)
    for (const int ray : {0, 1, 2, 3, 4, 5, 43, 44, 45, 46, 47})
      branches[0].sections[k].ends[static_cast<std::size_t>(ray)] = RayEnd::kOpen;
  EXPECT_EQ(verdictOf(scan, branches, 0, {}).use, Use::kUse);
  branches.pop_back();
  EXPECT_EQ(verdictOf(scan, branches, 0, {}).use, Use::kLook);
}

}  // namespace
}  // namespace endovascular_sim::segmentation
