#include "segmentation/view/straightened_view.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "phantom/phantom.h"

namespace endovascular_sim::segmentation
{
namespace
{

int countOf(const ColourPicture& picture, const Colour& colour)
{
  int count = 0;
  for (int row = 0; row < picture.height; ++row)
    for (int column = 0; column < picture.width; ++column)
      count += picture.at(column, row) == colour ? 1 : 0;
  return count;
}

TEST(StraightenedView, ShowsRaysWithoutAnEdgeCalciumBoneAndTurnsInColour)
{
  image::Volume volume;
  volume.grid = phantom::gridOfBox({0.0, 0.0, 0.0}, {0.02, 0.02, 0.05}, Eigen::Vector3d::Constant(1e-3));
  volume.stored.assign(volume.grid.voxels(), 0);
  const Scan scan(std::move(volume));
  LumenBranch branch;
  for (int k = 0; k < 80; ++k)
  {
    Section section;
    section.centre = {0.01, 0.01, 5e-4 * k};
    section.radii.fill(2e-3);
    section.ends.fill(RayEnd::kWall);
    section.reach = 4e-3;
    branch.sections.push_back(section);
  }
  const ColourPicture plain = straightenedView(scan, branch, {});
  const auto more = [&](const Colour& colour)
  { return countOf(straightenedView(scan, branch, {}), colour) - countOf(plain, colour); };
  for (std::size_t k = 20; k < 30; ++k)  // 5 mm, 50 columns
  {
    branch.sections[k].ends[3] = RayEnd::kOpen;
    branch.sections[k].ends[4] = RayEnd::kDropped;
    branch.sections[k].ends[5] = RayEnd::kCalcium;
    branch.sections[k].ends[0] = RayEnd::kBone;
  }
  EXPECT_EQ(more(kOpenColour), 200);     // two rays of two rows in the strip
  EXPECT_EQ(more(kCalciumColour), 100);  // one ray
  EXPECT_EQ(more(kBoneColour), 150);     // and in a cut
  EXPECT_EQ(more(kTurnColour), 0);
  const ColourPicture joined = straightenedView(scan, branch, [](const Eigen::Vector3d&) { return true; });
  EXPECT_EQ(countOf(joined, kJunctionColour) - countOf(plain, kJunctionColour), 200);
  branch.sections[60].centre.x() += 1e-3;
  EXPECT_GT(more(kTurnColour), 0);
}

TEST(ColourPicture, DrawsLettersWithinItsBorder)
{
  ColourPicture picture(20, 7);
  EXPECT_EQ(picture.draw(0, 0, "L I", kWallColour), 18);
  EXPECT_EQ(countOf(picture, kWallColour), 11 + 11);
  picture.draw(15, 3, "M", kWallColour);  // clipped
  picture.set(-1, 0, kWallColour);
  EXPECT_EQ(picture.pixels.size(), 3u * 20u * 7u);
}

}  // namespace
}  // namespace endovascular_sim::segmentation
