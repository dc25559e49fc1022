#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "common/error.h"
#include "common/fast_math.h"
#include "fluoroscopy/image/coarse_image.h"
#include "fluoroscopy/image/display.h"
#include "fluoroscopy/image/exposure_control.h"
#include "fluoroscopy/image/noise_source.h"
#include "fluoroscopy/image/scintillator_blur.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

TEST(FastMath, EqualsTheLibraryFunctions)
{
  for (float x = -80.0F; x < 80.0F; x += 0.0137F)
    ASSERT_NEAR(fastExp(x) / std::exp(static_cast<double>(x)), 1.0, 4e-7) << x;
  for (float x = 1e-30F; x < 1e30F; x *= 1.0173F)
    ASSERT_NEAR(fastLog(x), std::log(static_cast<double>(x)), 5e-7 + 3e-7 * std::abs(std::log(static_cast<double>(x))));
}

TEST(NoiseSource, HasTheMomentsOfTheNormalDistribution)
{
  constexpr int kCount = 400000;
  std::vector<float> a(kCount), b(kCount);
  NoiseSource(5, 9).fill(0, kCount, a.data(), b.data());
  double moments[4] = {}, product = 0.0, beyond = 0.0;
  for (int i = 0; i < kCount; ++i)
  {
    const auto k = static_cast<std::size_t>(i);
    for (const double x : {static_cast<double>(a[k]), static_cast<double>(b[k])})
    {
      for (int m = 0; m < 4; ++m)
        moments[m] += std::pow(x, m + 1) / (2.0 * kCount);
      beyond += std::abs(x) > 3.0 ? 0.5 / kCount : 0.0;
    }
    product += static_cast<double>(a[k] * b[k]) / kCount;
  }
  EXPECT_NEAR(moments[0], 0.0, 0.005);
  EXPECT_NEAR(moments[1], 1.0, 0.008);
  EXPECT_NEAR(moments[2], 0.0, 0.015);
  EXPECT_NEAR(moments[3], 3.0, 0.05);
  EXPECT_NEAR(product, 0.0, 0.006);
  EXPECT_NEAR(beyond, 0.0027, 0.0003);
}

TEST(NoiseSource, DoesNotDependOnTheOrderOfPixels)
{
  std::vector<float> a(100), b(100), c(40), d(40);
  const NoiseSource noise(1, 2);
  noise.fill(0, 100, a.data(), b.data());
  noise.fill(60, 40, c.data(), d.data());
  for (std::size_t k = 0; k < 40; ++k)
  {
    EXPECT_EQ(a[60 + k], c[k]);
    EXPECT_EQ(b[60 + k], d[k]);
  }
}

TEST(ScintillatorBlur, HasTheTransferFunctionOfTheScintillator)
{
  for (const double pitch : {0.15e-3, 0.2e-3, 0.4e-3, 0.6e-3})
  {
    const ScintillatorBlur blur(pitch);
    EXPECT_NEAR(blur.transfer(0.0), 1.0, 1e-6);
    const double f = 0.5e3 * pitch;  // [1/pixel]
    double expected = 0.0;           // aperture of pixel and photon, with aliases
    for (int m = -40; m <= 40; ++m)
    {
      const double g = f + m, aperture = std::sin(M_PI * g) / (M_PI * g);
      expected += aperture * aperture / (1.0 + 0.45e-6 * g * g / (pitch * pitch));
    }
    EXPECT_NEAR(blur.transfer(f), expected, 0.01) << pitch;
    EXPECT_GT(blur.transfer(0.2), blur.transfer(0.5));
  }
}

TEST(ScintillatorBlur, PreservesAUniformImageAndTheSumOfAPoint)
{
  ScintillatorBlur blur(0.2e-3);
  std::vector<float> image(64 * 64, 3.0F);
  blur.apply(64, image);
  for (const float value : image)
    ASSERT_NEAR(value, 3.0F, 1e-5F);
  image.assign(64 * 64, 0.0F);
  image[32 * 64 + 30] = 1.0F;
  blur.apply(64, image);
  EXPECT_NEAR(std::accumulate(image.begin(), image.end(), 0.0F), 1.0F, 1e-5F);
  EXPECT_EQ(image[32 * 64 + 31], image[32 * 64 + 29]);
  EXPECT_NEAR(image[33 * 64 + 30], image[32 * 64 + 31], 1e-7F);
}

TEST(CoarseImage, ReproducesMeansAndAffineFunctions)
{
  for (const int pixels : {16, 100, 512})
  {
    CoarseImage coarse(pixels);
    const auto n = static_cast<std::size_t>(pixels);
    std::vector<float> image(n * n), row(n);
    for (std::size_t k = 0; k < image.size(); ++k)
      image[k] = 2.0F + 0.01F * static_cast<float>(k % n) - 0.02F * static_cast<float>(k / n);
    coarse.average(image);
    const int middle = pixels / 2;
    coarse.row(middle, row.data());
    for (std::size_t column = n / 4; column < 3 * n / 4; ++column)
      ASSERT_NEAR(row[column], image[static_cast<std::size_t>(middle) * n + column], 0.02F) << pixels;
    image[5] += 1.0F;
    CoarseImage changed = coarse;
    changed.addPixel(5, 1.0F);
    coarse.average(image);
    EXPECT_NEAR(coarse.at(0, 5 / coarse.binPixels()), changed.at(0, 5 / coarse.binPixels()), 1e-5F);
  }
}

TEST(ExposureControl, GivesTheWantedDoseBehindAnyThickness)
{
  const Beam beam({});
  ExposureSettings settings;
  settings.max_air_kerma_rate = 1.0;
  for (const double thickness : {100.0, 200.0, 300.0})
  {
    const ExposureControl control(beam, settings);
    const double charge = control.tubeCharge(control.water().logSignal(thickness), 1.2, 0.75);
    EXPECT_NEAR(charge * control.water().detectorKerma(thickness) / 1.44, 30e-9, 0.02 * 30e-9);
    EXPECT_LT(charge, control.largestCharge(0.75));
  }
}

TEST(ExposureControl, KeepsTheLimitOfTheAirKermaRate)
{
  const ExposureControl control(Beam({}), {});
  const double charge = control.tubeCharge(control.water().logSignal(400.0), 1.2, 0.75);
  EXPECT_EQ(charge, control.largestCharge(0.75));
  EXPECT_NEAR(control.referenceKerma(charge, 0.75) * 15.0, 88e-3 / 60.0, 1e-9);
  ExposureSettings bad;
  bad.detector_dose = 0.0;
  EXPECT_THROW(ExposureControl(Beam({}), bad), InputError);
}

/** Image of a uniform count with a square of another count. */
std::vector<std::uint8_t> shown(const DisplaySettings& settings, std::uint16_t around, std::uint16_t square,
                                std::vector<std::uint8_t>* second = nullptr)
{
  constexpr int kPixels = 128;
  std::vector<std::uint16_t> raw(kPixels * kPixels, around);
  for (int row = 60; row < 68; ++row)
    for (int column = 60; column < 68; ++column)
      raw[static_cast<std::size_t>(row * kPixels + column)] = square;
  CoarseImage counts(kPixels);
  std::vector<float> full(raw.begin(), raw.end());
  counts.average(full);
  Display display(settings);
  std::vector<std::uint8_t> image;
  display.draw(kPixels, 0.2, 2000.0, counts, Collimator(kPixels, 0.2, 0.0, 0.0), raw, image);
  if (second != nullptr)
  {
    std::fill(raw.begin(), raw.end(), around);
    display.draw(kPixels, 0.2, 2000.0, counts, Collimator(kPixels, 0.2, 0.0, 0.0), raw, *second);
  }
  return image;
}

constexpr std::size_t kCorner = 10 * 128 + 10, kSquare = 64 * 128 + 64;

TEST(Display, ShowsContrastInDarkAndBrightSurroundings)
{
  for (const int count : {500, 2000, 8000, 30000})
  {
    const auto image = shown({}, static_cast<std::uint16_t>(count), static_cast<std::uint16_t>(0.8 * count));
    EXPECT_GT(image[kCorner], image[kSquare] + 15) << count;
    EXPECT_LT(image[kCorner], 255) << count;
    EXPECT_GT(image[kSquare], 0) << count;
  }
  EXPECT_NEAR(shown({}, 2000, 2000)[kCorner], 156, 2);
}

TEST(Display, InvertsMagnifiesAndFilters)
{
  DisplaySettings inverted;
  inverted.inverted = true;
  EXPECT_NEAR(shown(inverted, 2000, 1600)[kSquare] + shown({}, 2000, 1600)[kSquare], 255, 1);
  DisplaySettings zoomed;
  zoomed.zoom = 4.0;
  const std::size_t beside = 64 * 128 + 76;  // inside of the square magnified four times
  EXPECT_LT(shown(zoomed, 2000, 1600)[beside] + 15, shown({}, 2000, 1600)[beside]);
  DisplaySettings filtered;
  filtered.recursive_filter = 0.5;
  std::vector<std::uint8_t> second;
  const auto first = shown(filtered, 2000, 1600, &second);
  EXPECT_GT(second[kSquare], first[kSquare] + 5);
  EXPECT_LT(second[kSquare] + 5, second[kCorner]);
}

TEST(Display, RejectsSettingsOutOfRange)
{
  DisplaySettings settings;
  settings.zoom = 0.5;
  EXPECT_THROW(Display{settings}, InputError);
  settings = {};
  settings.recursive_filter = 1.0;
  EXPECT_THROW(Display{settings}, InputError);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
