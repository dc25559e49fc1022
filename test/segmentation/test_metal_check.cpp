#include "segmentation/metal_check.h"

#include <gtest/gtest.h>

namespace endovascular_sim::segmentation
{
namespace
{

/** Volume of fat with a cube of 3 × 3 × 3 voxels of a value around (16, 3, 10) mm of the grid. */
image::Volume scanWith(double value)
{
  image::Volume volume;
  volume.grid.size = {41, 41, 41};
  volume.grid.spacing.setConstant(5e-4);
  volume.grid.origin = {-0.1, 0.2, 0.3};
  volume.stored.assign(volume.grid.voxels(), -90);
  for (int n = 0; n < 27; ++n)
    volume.stored[volume.grid.offset(31 + n % 3, 5 + n / 3 % 3, 19 + n / 9)] = static_cast<std::int16_t>(value);
  return volume;
}

LumenBranch branchAt(double x)
{
  LumenBranch branch;
  branch.name = "artery";
  for (int k = 0; k <= 40; ++k)
  {
    Section section;
    section.centre = Eigen::Vector3d(x, 0.01, 5e-4 * k);
    section.radii.fill(2e-3);
    branch.sections.push_back(section);
  }
  return branch;
}

TEST(MetalCheck, NamesThePlaceOfMetalBesideABranch)
{
  const std::vector<std::string> warnings = metalWarnings(Scan(scanWith(3071.0)), {branchAt(0.01)});
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].rfind("artery: metal at (-84.", 0), 0U) << warnings[0];
  EXPECT_NE(warnings[0].find("mm from its axis at 10 mm: streaks may displace"), std::string::npos) << warnings[0];
}

TEST(MetalCheck, IgnoresCalciumMetalFarAwayAndValuesWithoutAUnit)
{
  EXPECT_TRUE(metalWarnings(Scan(scanWith(1500.0)), {branchAt(0.01)}).empty());
  EXPECT_TRUE(metalWarnings(Scan(scanWith(3071.0)), {branchAt(-0.04)}).empty());
  image::Volume magnetic = scanWith(3071.0);
  magnetic.modality = image::Modality::kOther;
  EXPECT_TRUE(metalWarnings(Scan(magnetic), {branchAt(0.01)}).empty());
}

}  // namespace
}  // namespace endovascular_sim::segmentation
