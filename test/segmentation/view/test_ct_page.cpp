#include "segmentation/view/ct_page.h"

#include <gtest/gtest.h>

namespace endovascular_sim::segmentation
{
namespace
{

TEST(Base64, IsThatOfRfc4648)
{
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

TEST(CtPage, HoldsAtMost25MegabytesAndNoReferences)
{
  image::Volume volume;
  volume.grid.size = {320, 320, 320};
  volume.grid.spacing = {4e-4, 4e-4, 5e-4};
  volume.stored.assign(volume.grid.voxels(), 100);
  const std::string page = ctPage(Scan(volume));
  EXPECT_LT(page.size(), 25000000u);
  EXPECT_EQ(page.find("http"), std::string::npos);
  EXPECT_NE(page.find("\"size\":[320,160,320]"), std::string::npos);
}

TEST(CtPage, JudgesClicksByTheLimitsOfTheirCheck)
{
  image::Volume volume;
  volume.grid.size = {4, 4, 4};
  volume.grid.spacing = {1e-3, 1e-3, 1e-3};
  volume.stored.assign(volume.grid.voxels(), 100);
  const std::string page = ctPage(Scan(volume));
  EXPECT_NE(page.find("{\"below\":-20.0,\"name\":\"fat, air or lung\"},"
                      "{\"below\":150.0,\"name\":\"soft tissue or the wall\"}"),
            std::string::npos);
  EXPECT_NE(page.find("\"onWall\":0.45,\"inLumen\":0.75"), std::string::npos);
}

TEST(CtPage, AddsNoClickTwice)
{
  image::Volume volume;
  volume.grid.size = {4, 4, 4};
  volume.grid.spacing = {1e-3, 1e-3, 1e-3};
  volume.stored.assign(volume.grid.voxels(), 100);
  const std::string page = ctPage(Scan(volume));
  const std::size_t add = page.find("function add()");
  const std::size_t comparison = page.find("clicks.some(c => c.name == name && c.voxel.join() == cross.join())", add);
  ASSERT_NE(comparison, std::string::npos);
  EXPECT_LT(comparison, page.find("clicks.push(", add));
}

}  // namespace
}  // namespace endovascular_sim::segmentation
