#include "fluoroscopy/projection/areal_density_image.h"

#include <algorithm>
#include <cstddef>

#include "common/error.h"

namespace endovascular_sim::fluoroscopy
{

ArealDensityImage emptyImage(int samples)
{
  if (samples < 1 || samples > 4096)
    throw InputError("projection of the patient", "samples", "must lie between 1 and 4096");
  const std::size_t size = static_cast<std::size_t>(samples) * static_cast<std::size_t>(samples);
  return {samples, std::vector<float>(size, 0.0F), std::vector<float>(size, 0.0F)};
}

namespace
{

/** Samples on both sides of each pixel of a row or column, and the place between them. */
struct Places
{
  std::vector<int> lower, upper;
  std::vector<float> fraction;

  Places(int n, int pixels)
    : lower(static_cast<std::size_t>(pixels)),
      upper(static_cast<std::size_t>(pixels)),
      fraction(static_cast<std::size_t>(pixels))
  {
    for (int i = 0; i < pixels; ++i)
    {
      const double position = std::clamp((i + 0.5) * n / pixels - 0.5, 0.0, static_cast<double>(n - 1));
      const auto at = static_cast<std::size_t>(i);
      lower[at] = static_cast<int>(position);
      upper[at] = std::min(lower[at] + 1, n - 1);
      fraction[at] = static_cast<float>(position - lower[at]);
    }
  }
};

/** Gives the interpolated value of every pixel to put(value, pixel). */
template <typename Put>
void resample(const std::vector<float>& from, int n, const Places& places, const Put& put)
{
  const std::size_t size = places.lower.size();
  std::vector<float> blended(static_cast<std::size_t>(n));
  for (std::size_t row = 0; row < size; ++row)
  {
    const float* above = from.data() + static_cast<std::ptrdiff_t>(places.lower[row]) * n;
    const float* below = from.data() + static_cast<std::ptrdiff_t>(places.upper[row]) * n;
    for (std::size_t i = 0; i < blended.size(); ++i)
      blended[i] = above[i] + places.fraction[row] * (below[i] - above[i]);
    for (std::size_t column = 0; column < size; ++column)
    {
      const float left = blended[static_cast<std::size_t>(places.lower[column])];
      put(left + places.fraction[column] * (blended[static_cast<std::size_t>(places.upper[column])] - left),
          row * size + column);
    }
  }
}

}  // namespace

ArealDensityImage resampled(const ArealDensityImage& image, int pixels)
{
  if (pixels == image.samples)
    return image;
  ArealDensityImage result = emptyImage(pixels);
  const Places places(image.samples, pixels);
  resample(image.tissue, image.samples, places, [&](float value, std::size_t k) { result.tissue[k] = value; });
  resample(image.bone, image.samples, places, [&](float value, std::size_t k) { result.bone[k] = value; });
  return result;
}

void addResampled(const std::vector<float>& change, int samples, int pixels, std::vector<float>& densities)
{
  resample(change, samples, Places(samples, pixels),
           [&](float value, std::size_t k) { densities[k] = std::max(densities[k] + value, 0.0F); });
}

}  // namespace endovascular_sim::fluoroscopy
