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

}  // namespace
}  // namespace endovascular_sim::segmentation
