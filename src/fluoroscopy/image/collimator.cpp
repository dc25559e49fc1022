#include "fluoroscopy/image/collimator.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr float kInside = 0.95F;  // share from which a bin is inside
constexpr float kFewest = 1e-3F;  // sum of weights below which the mean of the field is used

/** Factors of the pixels along one axis. */
std::vector<float> profile(int pixels, double detector_width, double field)
{
  std::vector<float> factors(static_cast<std::size_t>(pixels), 1.0F);
  if (field <= 0.0 || field >= detector_width)
    return factors;
  const double pitch = detector_width / pixels;
  for (int k = 0; k < pixels; ++k)
  {
    const double outside = std::abs((k - 0.5 * (pixels - 1)) * pitch) - 0.5 * field;
    const double x = std::clamp(0.5 - outside / Collimator::kPenumbra, 0.0, 1.0);
    factors[static_cast<std::size_t>(k)] = static_cast<float>(x * x * (3.0 - 2.0 * x));
  }
  return factors;
}

double openSide(double field, double detector_width)
{
  return field > 0.0 ? std::min(field, detector_width) : detector_width;
}

}  // namespace

Collimator::Collimator(int pixels, double detector_width, double width, double height)
  : open_(openSide(width, detector_width) == detector_width && openSide(height, detector_width) == detector_width),
    side_(open_ ? detector_width : std::sqrt(openSide(width, detector_width) * openSide(height, detector_width))),
    columns_(profile(pixels, detector_width, width)),
    rows_(profile(pixels, detector_width, height))
{
}

void Collimator::apply(std::vector<float>& signal) const
{
  if (open_)
    return;
  constexpr auto kBlades = static_cast<float>(kTransmission);
  std::size_t k = 0;
  for (const float row : rows_)
    for (const float column : columns_)
      signal[k++] *= kBlades + (1.0F - kBlades) * row * column;
}

CoarseImage extended(const CoarseImage& image, const Collimator& collimator, int pixels, double sigma)
{
  std::vector<float> share;
  share.reserve(static_cast<std::size_t>(pixels) * static_cast<std::size_t>(pixels));
  for (int row = 0; row < pixels; ++row)
    for (int column = 0; column < pixels; ++column)
      share.push_back(collimator.share(row, column));
  CoarseImage weights(pixels), result = image;
  weights.average(share);
  const float threshold = std::min(kInside, *std::max_element(weights.values().begin(), weights.values().end()));
  float sum = 0.0F, count = 0.0F;
  for (std::size_t k = 0; k < result.values().size(); ++k)
  {
    weights.values()[k] = weights.values()[k] >= threshold ? 1.0F : 0.0F;
    result.values()[k] *= weights.values()[k];
    sum += result.values()[k];
    count += weights.values()[k];
  }
  weights.blur(sigma, false);
  result.blur(sigma, false);
  for (std::size_t k = 0; k < result.values().size(); ++k)
  {
    const float weight = weights.values()[k];
    result.values()[k] = weight > kFewest ? result.values()[k] / weight : sum / count;
  }
  return result;
}

}  // namespace endovascular_sim::fluoroscopy
