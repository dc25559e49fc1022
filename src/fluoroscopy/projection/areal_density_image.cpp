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

ArealDensityImage resampled(const ArealDensityImage& image, int pixels)
{
  if (pixels == image.samples)
    return image;
  ArealDensityImage result = emptyImage(pixels);
  const int n = image.samples;
  const auto size = static_cast<std::size_t>(pixels);
  std::vector<int> lower(size), upper(size);
  std::vector<float> fraction(size);
  for (int i = 0; i < pixels; ++i)
  {
    const double position = std::clamp((i + 0.5) * n / pixels - 0.5, 0.0, static_cast<double>(n - 1));
    const auto at = static_cast<std::size_t>(i);
    lower[at] = static_cast<int>(position);
    upper[at] = std::min(lower[at] + 1, n - 1);
    fraction[at] = static_cast<float>(position - lower[at]);
  }
  std::vector<float> blended(static_cast<std::size_t>(n));
  const auto resample = [&](const std::vector<float>& from, std::vector<float>& to)
  {
    for (std::size_t row = 0; row < size; ++row)
    {
      const float* above = from.data() + static_cast<std::ptrdiff_t>(lower[row]) * n;
      const float* below = from.data() + static_cast<std::ptrdiff_t>(upper[row]) * n;
      for (std::size_t i = 0; i < blended.size(); ++i)
        blended[i] = above[i] + fraction[row] * (below[i] - above[i]);
      float* target = to.data() + row * size;
      for (std::size_t column = 0; column < size; ++column)
      {
        const float left = blended[static_cast<std::size_t>(lower[column])];
        target[column] = left + fraction[column] * (blended[static_cast<std::size_t>(upper[column])] - left);
      }
    }
  };
  resample(image.tissue, result.tissue);
  resample(image.bone, result.bone);
  return result;
}

}  // namespace endovascular_sim::fluoroscopy
