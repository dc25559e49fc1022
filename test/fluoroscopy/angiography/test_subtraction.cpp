#include "fluoroscopy/angiography/subtraction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fluoroscopy/angiography/mask.h"
#include "fluoroscopy/angiography/peak_opacity.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr int kPixels = 48;

/** Smooth image with a shift. */
std::vector<float> waves(double columns, double rows)
{
  std::vector<float> image;
  for (int row = 0; row < kPixels; ++row)
    for (int column = 0; column < kPixels; ++column)
      image.push_back(static_cast<float>(std::sin(0.3 * (column - columns)) + std::cos(0.25 * (row - rows))));
  return image;
}

double largestWithin(const std::vector<float>& a, const std::vector<float>& b, int margin)
{
  double largest = 0.0;
  for (int row = margin; row < kPixels - margin; ++row)
    for (int column = margin; column < kPixels - margin; ++column)
    {
      const auto k = static_cast<std::size_t>(row * kPixels + column);
      largest = std::max(largest, std::abs(static_cast<double>(a[k]) - static_cast<double>(b[k])));
    }
  return largest;
}

TEST(Subtraction, ShiftsAnImageByFractionsOfAPixel)
{
  const std::vector<float> image = waves(0.0, 0.0);
  EXPECT_EQ(shifted(image, kPixels, {0.0, 0.0}), image);
  for (const Eigen::Vector2d& shift : {Eigen::Vector2d(0.5, -0.3), Eigen::Vector2d(-2.25, 1.6)})
    EXPECT_LT(largestWithin(shifted(image, kPixels, shift), waves(shift.x(), shift.y()), 5), 2e-3) << shift;
  EXPECT_LT(largestWithin(shifted(image, kPixels, {3.0, -1.0}), waves(3.0, -1.0), 5), 1e-6);
}

TEST(Subtraction, RepeatsTheEdgeBeyondIt)
{
  const std::vector<float> moved = shifted(waves(0.0, 0.0), kPixels, {10.0, 0.0});
  for (int column = 0; column < 10; ++column)
    EXPECT_EQ(moved[static_cast<std::size_t>(column)], moved[10]);
}

TEST(Subtraction, IsTheLogarithmOfTheRatio)
{
  const std::vector<std::uint16_t> counts(kPixels * kPixels, 1000);
  const std::vector<float> mask(kPixels * kPixels, std::log(2000.0F));
  for (const float value : logDifference(counts, mask, kPixels, {0.0, 0.0}))
    ASSERT_NEAR(value, -std::log(2.0F), 1e-5F);
  const std::vector<std::uint16_t> dark(kPixels * kPixels, 0);
  for (const float value : logDifference(dark, mask, kPixels, {1.5, 0.0}))
    ASSERT_TRUE(std::isfinite(value));
}

TEST(Mask, IsTheMeanOfItsFrames)
{
  Mask mask(3);
  const CArmPose pose;
  for (const std::uint16_t count : {100, 200, 600})
  {
    EXPECT_FALSE(mask.isComplete());
    mask.add(static_cast<std::uint64_t>(mask.taken()) + 7, {count, 5}, 1.0, pose);
  }
  ASSERT_TRUE(mask.isComplete());
  EXPECT_NEAR(mask.logarithms()[0], std::log(300.0), 1e-5);
  EXPECT_NEAR(mask.logarithms()[1], std::log(5.0), 1e-6);
}

TEST(Mask, BeginsAnewAfterAMotionAndAfterAGap)
{
  const CArmPose pose;
  CArmPose moved;
  moved.isocentre.z() = 0.01;
  Mask mask(3);
  mask.add(1, {100}, 1.0, pose);
  mask.add(2, {100}, 1.0, moved);
  EXPECT_EQ(mask.taken(), 1);
  mask.add(4, {100}, 1.0, moved);
  EXPECT_EQ(mask.taken(), 1);
  mask.add(5, {200}, 1.0, moved);
  EXPECT_EQ(mask.taken(), 2);
  mask.add(6, {300}, 1.0, moved);
  EXPECT_NEAR(mask.logarithms()[0], std::log(200.0), 1e-5);
}

TEST(Mask, NamesTheMotionBetweenTwoPoses)
{
  const CArmPose before;
  EXPECT_EQ(motionBetween(before, before), "");
  const auto after = [&](double CArmPose::*quantity)
  {
    CArmPose pose = before;
    pose.*quantity += 0.01;
    return motionBetween(before, pose);
  };
  for (const auto quantity : {&CArmPose::primary_angle, &CArmPose::secondary_angle, &CArmPose::source_to_detector,
                              &CArmPose::source_to_patient})
    EXPECT_EQ(after(quantity), "the C-arm has moved");
  EXPECT_EQ(after(&CArmPose::detector_width), "the width of the detector has changed");
  EXPECT_EQ(after(&CArmPose::field_width), "the collimated field has changed");
  EXPECT_EQ(after(&CArmPose::field_height), "the collimated field has changed");
  CArmPose panned = before;
  panned.isocentre.y() += 0.01;
  EXPECT_EQ(motionBetween(before, panned), "the table has moved");
}

TEST(PeakOpacity, KeepsTheLargestOpacityOfEveryPixelAboveTheBackground)
{
  PeakOpacity peak;
  EXPECT_TRUE(peak.empty());
  for (int frame = 0; frame < 3; ++frame)
  {
    std::vector<float> difference(kPixels * kPixels, -0.1F);  // an offset, as by scatter
    for (int row = 10 * frame; row < 10 * frame + 10; ++row)  // the front moves on
      for (int column = 20; column < 26; ++column)
        difference[static_cast<std::size_t>(row * kPixels + column)] = -0.6F;
    peak.add(difference, kPixels);
  }
  const std::vector<float> image = peak.image();
  const auto at = [&](int row, int column) { return image[static_cast<std::size_t>(row * kPixels + column)]; };
  for (const int row : {5, 15, 25})
    EXPECT_NEAR(at(row, 23), 0.5F, 1e-5F) << row;
  EXPECT_EQ(at(40, 23), 0.0F);
  EXPECT_EQ(at(15, 5), 0.0F);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
