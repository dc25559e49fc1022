#include "fluoroscopy/angiography/peak_opacity.h"

#include <algorithm>
#include <cstddef>

namespace endovascular_sim::fluoroscopy
{
namespace
{

/** Mean of three neighbours along one axis; the edge is repeated. */
void average(std::vector<float>& image, int pixels, std::ptrdiff_t step, std::ptrdiff_t across)
{
  for (std::ptrdiff_t line = 0; line < pixels; ++line)
  {
    float* const begin = image.data() + line * across;
    float before = begin[0];
    for (std::ptrdiff_t k = 0; k < pixels; ++k)
    {
      const float here = begin[k * step];
      const float after = begin[std::min<std::ptrdiff_t>(k + 1, pixels - 1) * step];
      begin[k * step] = (before + here + after) * (1.0F / 3.0F);
      before = here;
    }
  }
}

}  // namespace

void PeakOpacity::add(const std::vector<float>& difference, int pixels)
{
  std::vector<float> opacity = difference;
  average(opacity, pixels, 1, pixels);
  average(opacity, pixels, pixels, 1);
  if (largest_.size() != opacity.size())
    largest_.assign(opacity.size(), -1e3F);
  for (std::size_t k = 0; k < opacity.size(); ++k)
    largest_[k] = std::max(largest_[k], -opacity[k]);
}

std::vector<float> PeakOpacity::image() const
{
  std::vector<float> result = largest_;
  const auto middle = result.begin() + static_cast<std::ptrdiff_t>(result.size() / 2);
  std::nth_element(result.begin(), middle, result.end());
  const float zero = *middle;
  for (std::size_t k = 0; k < result.size(); ++k)
    result[k] = std::max(largest_[k] - zero, 0.0F);
  return result;
}

}  // namespace endovascular_sim::fluoroscopy
