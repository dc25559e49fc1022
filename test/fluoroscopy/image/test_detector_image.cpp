#include "fluoroscopy/image/detector_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "fluoroscopy/image/scatter.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr int kPixels = 256;
constexpr double kPixelWidth = 0.39e-3;  // [m]
constexpr double kWidth = kPixels * kPixelWidth;
constexpr double kDistance = 1.2;  // SID [m]

const Beam& beam()
{
  static const Beam kBeam({});
  return kBeam;
}

const WaterEquivalent& water()
{
  static const WaterEquivalent kWater(beam());
  return kWater;
}

/** Uniform field behind 20 cm of water. */
class Field
{
public:
  Field() : image_(kPixels, kWidth, kDistance, water(), kWidth), mean_(kPixels)
  {
    signal_ = std::exp(water().logSignal(200.0));
    mean_.average(std::vector<float>(kPixels * kPixels, static_cast<float>(signal_)));
    weight_.assign(kPixels * kPixels, 60.0F);
  }

  /** Tube charge of a dose at the detector [mAs]. */
  static double charge(double dose) { return dose * kDistance * kDistance / water().detectorKerma(200.0); }

  std::vector<std::uint16_t> frame(double dose, std::uint64_t frame, std::uint64_t seed = 1)
  {
    std::vector<float> primary(kPixels * kPixels, static_cast<float>(signal_));
    std::vector<std::uint16_t> raw;
    image_.form({charge(dose), seed, frame}, primary, mean_, weight_, raw);
    return raw;
  }

  DetectorImage& image() { return image_; }

private:
  DetectorImage image_;
  CoarseImage mean_;
  double signal_ = 0.0;
  std::vector<float> weight_;
};

/** Difference of two frames over the central 128 × 128 pixels. */
std::vector<double> difference(Field& field, double dose, std::uint64_t frame)
{
  const std::vector<std::uint16_t> a = field.frame(dose, 2 * frame), b = field.frame(dose, 2 * frame + 1);
  std::vector<double> result;
  for (int row = 64; row < 192; ++row)
    for (int column = 64; column < 192; ++column)
    {
      const auto k = static_cast<std::size_t>(row * kPixels + column);
      result.push_back((static_cast<double>(a[k]) - static_cast<double>(b[k])) / std::sqrt(2.0));
    }
  return result;
}

double variance(const std::vector<double>& values)
{
  double sum = 0.0;
  for (const double value : values)
    sum += value * value / static_cast<double>(values.size());
  return sum;
}

double quantumVariance(Field& field, double dose)
{
  constexpr int kPairs = 24;
  double sum = 0.0;
  for (int k = 0; k < kPairs; ++k)
    sum += variance(difference(field, dose, static_cast<std::uint64_t>(k))) / kPairs;
  return sum - DetectorImage::kReadOutNoise * DetectorImage::kReadOutNoise - 1.0 / 12.0;
}

TEST(DetectorImage, HasTheSignalOfThePrimaryDoseAndTheScatter)
{
  Field field;
  const std::vector<std::uint16_t> raw = field.frame(30e-9, 0);
  double mean = 0.0;
  for (int row = 96; row < 160; ++row)
    for (int column = 96; column < 160; ++column)
      mean += raw[static_cast<std::size_t>(row * kPixels + column)] / 4096.0;
  const double primary = DetectorImage::kCountsPerGray * 30e-9;
  EXPECT_GT(mean, 1.05 * primary);
  EXPECT_LT(mean, (1.0 + scatterToPrimary(200.0, kWidth)) * primary);
}

TEST(DetectorImage, HasAQuantumVarianceInProportionToTheDose)
{
  Field field;
  const double low = quantumVariance(field, 15e-9), middle = quantumVariance(field, 30e-9),
               high = quantumVariance(field, 150e-9);
  EXPECT_NEAR(middle / low, 2.0, 0.02 * 2.0);
  EXPECT_NEAR(high / middle, 5.0, 0.02 * 5.0);
}

TEST(DetectorImage, HasTheVarianceOfTheAbsorbedQuanta)
{
  Field field;
  const double pixel = kPixelWidth * kPixelWidth / (kDistance * kDistance);
  const double energy = std::exp(water().logSignal(200.0)) * Field::charge(30e-9) * pixel;  // primary [keV]
  const double counts = DetectorImage::kCountsPerGray * 30e-9;
  double blurred = 0.0;  // factor of the variance by the kernel along one axis
  for (std::size_t k = 0; k < field.image().blur().taps().size(); ++k)
    blurred += (k == 0 ? 1.0 : 2.0) * std::pow(static_cast<double>(field.image().blur().taps()[k]), 2);
  const double primary = counts * counts * 60.0 / energy * blurred * blurred;
  const double measured = quantumVariance(field, 30e-9);
  EXPECT_GT(measured, 1.05 * primary);
  EXPECT_LT(measured, (1.0 + scatterToPrimary(200.0, kWidth)) * primary);
}

TEST(DetectorImage, HasWhiteNoiseBeforeTheScintillator)
{
  // Noise power over the squared transfer function of the kernel, up to 0.8 of the Nyquist frequency.
  Field field;
  constexpr int kSize = 128, kPairs = 48, kLast = 51, kBins = 4;
  std::vector<double> ratio(kBins, 0.0);
  std::vector<int> count(kBins, 0);
  for (int pair = 0; pair < kPairs; ++pair)
  {
    const std::vector<double> noise = difference(field, 150e-9, static_cast<std::uint64_t>(pair));
    for (int u = 1; u <= kLast; u += 2)
    {
      std::vector<std::complex<double>> lines(kSize);
      for (int row = 0; row < kSize; ++row)
        for (int column = 0; column < kSize; ++column)
          lines[static_cast<std::size_t>(row)] +=
              noise[static_cast<std::size_t>(row * kSize + column)] * std::polar(1.0, -2.0 * M_PI * u * column / kSize);
      for (int v = -kLast; v <= kLast; v += 2)
      {
        std::complex<double> sum = 0.0;
        for (int row = 0; row < kSize; ++row)
          sum += lines[static_cast<std::size_t>(row)] * std::polar(1.0, -2.0 * M_PI * v * row / kSize);
        const double transfer = field.image().blur().transfer(static_cast<double>(u) / kSize) *
                                field.image().blur().transfer(static_cast<double>(v) / kSize);
        const double read_out = DetectorImage::kReadOutNoise * DetectorImage::kReadOutNoise + 1.0 / 12.0;
        const auto bin = static_cast<std::size_t>(kBins * std::max(u, std::abs(v)) / (kLast + 1));
        ratio[bin] += (std::norm(sum) / (kSize * kSize) - read_out) / (transfer * transfer);
        ++count[bin];
      }
    }
  }
  double mean = 0.0;
  for (std::size_t k = 0; k < kBins; ++k)
    mean += ratio[k] / count[k] / kBins;
  for (std::size_t k = 0; k < kBins; ++k)
    EXPECT_NEAR(ratio[k] / count[k] / mean, 1.0, 0.05)
        << "up to " << 0.8 * static_cast<double>(k + 1) / kBins << " of the Nyquist frequency";
}

TEST(DetectorImage, HasIndependentNoiseInEveryFrame)
{
  Field field;
  const auto correlation = [](const std::vector<double>& a, const std::vector<double>& b)
  {
    double sum = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k)
      sum += a[k] * b[k] / static_cast<double>(a.size());
    return sum / std::sqrt(variance(a) * variance(b));
  };
  double mean = 0.0;
  for (std::uint64_t k = 0; k < 20; ++k)
    mean += correlation(difference(field, 30e-9, k), difference(field, 30e-9, k + 1)) / 20.0;
  EXPECT_LT(std::abs(mean), 0.01);
}

TEST(DetectorImage, IsBitwiseReproducible)
{
  Field field, other;
  EXPECT_EQ(field.frame(30e-9, 7, 3), other.frame(30e-9, 7, 3));
  EXPECT_NE(field.frame(30e-9, 7, 3), field.frame(30e-9, 8, 3));
  EXPECT_NE(field.frame(30e-9, 7, 3), field.frame(30e-9, 7, 4));
}

TEST(DetectorImage, SaturatesAtFullScale)
{
  Field field;
  EXPECT_EQ(field.frame(3e-6, 0)[0], 65535);
}

TEST(Scatter, GrowsWithThicknessAndField)
{
  EXPECT_NEAR(scatterToPrimary(200.0, 0.3), 0.378, 0.01);
  EXPECT_GT(scatterToPrimary(300.0, 0.3), 1.5 * scatterToPrimary(200.0, 0.3));
  EXPECT_LT(scatterToPrimary(200.0, 0.1), 0.7 * scatterToPrimary(200.0, 0.3));
  EXPECT_EQ(scatterToPrimary(0.0, 0.3), 0.0);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
