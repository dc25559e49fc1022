#include "fluoroscopy/image/collimator.h"

#include <gtest/gtest.h>

#include <numeric>

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr int kPixels = 300;
constexpr double kWidth = 0.3;  // of the detector [m]: pixels of 1 mm

TEST(Collimator, IsOpenWithoutASideOrWithOneAsLongAsTheDetector)
{
  EXPECT_TRUE(Collimator(kPixels, kWidth, 0.0, 0.0).isOpen());
  EXPECT_TRUE(Collimator(kPixels, kWidth, 0.3, 0.0).isOpen());
  EXPECT_FALSE(Collimator(kPixels, kWidth, 0.0, 0.1).isOpen());
  EXPECT_DOUBLE_EQ(Collimator(kPixels, kWidth, 0.0, 0.0).side(), kWidth);
  EXPECT_DOUBLE_EQ(Collimator(kPixels, kWidth, 0.04, 0.09).side(), 0.06);
}

TEST(Collimator, HasASoftEdgeAtHalfTheTransmission)
{
  const Collimator collimator(kPixels, kWidth, 0.101, 0.0);
  EXPECT_EQ(collimator.share(10, 149), 1.0F);
  EXPECT_EQ(collimator.share(10, 198), 1.0F);          // 48.5 mm from the axis, 2 mm inside
  EXPECT_NEAR(collimator.share(10, 200), 0.5F, 1e-3);  // 50.5 mm
  EXPECT_EQ(collimator.share(10, 202), 0.0F);
  EXPECT_EQ(collimator.share(10, 99), collimator.share(10, 200));
  for (int column = 150; column < kPixels - 1; ++column)
    EXPECT_GE(collimator.share(0, column), collimator.share(0, column + 1));
}

TEST(Collimator, ItsFieldHasTheGivenArea)
{
  const Collimator collimator(kPixels, kWidth, 0.08, 0.12);
  double area = 0.0;
  for (int row = 0; row < kPixels; ++row)
    for (int column = 0; column < kPixels; ++column)
      area += static_cast<double>(collimator.share(row, column)) * 1e-6;
  EXPECT_NEAR(area, 0.08 * 0.12, 1e-4 * area);
}

TEST(Collimator, ItsBladesTransmitATrace)
{
  std::vector<float> signal(kPixels * kPixels, 1000.0F);
  Collimator(kPixels, kWidth, 0.08, 0.08).apply(signal);
  EXPECT_FLOAT_EQ(signal[0], 2.0F);
  EXPECT_FLOAT_EQ(signal[150 * kPixels + 150], 1000.0F);
}

TEST(Collimator, ExtendsTheMeansOfItsFieldToTheWholeImage)
{
  const Collimator collimator(kPixels, kWidth, 0.1, 0.1);
  std::vector<float> full;
  for (int row = 0; row < kPixels; ++row)
    for (int column = 0; column < kPixels; ++column)
      full.push_back(collimator.share(row, column) > 0.0F ? 3.0F : -50.0F);
  CoarseImage image(kPixels);
  image.average(full);
  CoarseImage whole = extended(image, collimator, kPixels, 10.0);
  for (const float value : whole.values())
    EXPECT_NEAR(value, 3.0F, 1e-4F);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
