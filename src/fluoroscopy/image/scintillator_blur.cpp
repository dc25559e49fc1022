#include "fluoroscopy/image/scintillator_blur.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/units.h"
#include "common/wide_vectors.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

using units::kPi;
constexpr double kSpread = 0.45e-6;  // H [m²]
constexpr double kSmallest = 1e-3;   // of the taps that are retained
constexpr int kLargestRadius = 12;
constexpr int kSteps = 400;  // per pixel, of the integral of a tap

/** output = Σ taps · input along a line; @p stride is the distance of neighbours in @p input. */
EVS_WIDE_VECTORS void convolve(const float* input, std::ptrdiff_t stride, const float* taps, int radius, float* output,
                               int count)
{
  for (int i = 0; i < count; ++i)
    output[i] = taps[0] * input[i];
  for (int k = 1; k <= radius; ++k)
  {
    const float tap = taps[k];
    const float* before = input - k * stride;
    const float* after = input + k * stride;
    for (int i = 0; i < count; ++i)
      output[i] += tap * (before[i] + after[i]);
  }
}

}  // namespace

ScintillatorBlur::ScintillatorBlur(double pitch)
{
  const double decay = 2.0 * kPi / std::sqrt(kSpread) * pitch;  // [1/pixel]
  double sum = 0.0;
  std::vector<double> taps;
  for (int k = 0; k <= kLargestRadius; ++k)
  {
    double tap = 0.0;
    for (int i = 0; i < 2 * kSteps; ++i)
    {
      const double x = (i + 0.5) / kSteps - 1.0;  // from −1 to 1 pixel around the tap
      tap += (1.0 - std::abs(x)) * 0.5 * decay * std::exp(-decay * std::abs(k + x)) / kSteps;
    }
    if (k > 0 && tap < kSmallest)
      break;
    taps.push_back(tap);
    sum += k == 0 ? tap : 2.0 * tap;
  }
  for (const double tap : taps)
    taps_.push_back(static_cast<float>(tap / sum));
}

double ScintillatorBlur::transfer(double frequency) const
{
  double sum = static_cast<double>(taps_[0]);
  for (std::size_t k = 1; k < taps_.size(); ++k)
    sum += 2.0 * static_cast<double>(taps_[k]) * std::cos(2.0 * kPi * frequency * static_cast<double>(k));
  return sum;
}

void ScintillatorBlur::apply(int pixels, std::vector<float>& image)
{
  const auto n = static_cast<std::size_t>(pixels);
  const int radius = static_cast<int>(taps_.size()) - 1;
  const auto pad = static_cast<std::size_t>(radius);
  rows_.resize(n * (n + 2 * pad));
  line_.resize(n + 2 * pad);
  for (std::size_t row = 0; row < n; ++row)
  {
    const float* input = image.data() + row * n;
    std::fill_n(line_.begin(), pad, input[0]);
    std::copy_n(input, n, line_.begin() + static_cast<std::ptrdiff_t>(pad));
    std::fill_n(line_.begin() + static_cast<std::ptrdiff_t>(pad + n), pad, input[n - 1]);
    convolve(line_.data() + pad, 1, taps_.data(), radius, rows_.data() + (row + pad) * n, pixels);
  }
  for (std::size_t k = 0; k < pad; ++k)
  {
    std::copy_n(rows_.data() + pad * n, n, rows_.data() + k * n);
    std::copy_n(rows_.data() + (pad + n - 1) * n, n, rows_.data() + (pad + n + k) * n);
  }
  for (std::size_t row = 0; row < n; ++row)
    convolve(rows_.data() + (row + pad) * n, pixels, taps_.data(), radius, image.data() + row * n, pixels);
}

}  // namespace endovascular_sim::fluoroscopy
