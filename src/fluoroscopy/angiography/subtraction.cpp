#include "fluoroscopy/angiography/subtraction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "common/fast_math.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

/** Moves an image along one axis.
 *  @param step distance of neighbours along this axis, @p across that of its lines [element] */
void shiftLines(const std::vector<float>& source, int pixels, std::ptrdiff_t step, std::ptrdiff_t across, double shift,
                std::vector<float>& target)
{
  const double whole = std::floor(-shift);
  const double t = -shift - whole;  // place between two pixels, in [0, 1)
  const auto first = static_cast<std::ptrdiff_t>(whole) - 1;
  const std::array<float, 4> weights = {
      static_cast<float>(t * (-0.5 + t * (1.0 - 0.5 * t))), static_cast<float>(1.0 + t * t * (-2.5 + 1.5 * t)),
      static_cast<float>(t * (0.5 + t * (2.0 - 1.5 * t))), static_cast<float>(t * t * (-0.5 + 0.5 * t))};
  for (std::ptrdiff_t line = 0; line < pixels; ++line)
    for (std::ptrdiff_t k = 0; k < pixels; ++k)
    {
      float sum = 0.0F;
      for (std::ptrdiff_t i = 0; i < 4; ++i)
      {
        const std::ptrdiff_t at = std::clamp<std::ptrdiff_t>(k + first + i, 0, pixels - 1);
        sum += weights[static_cast<std::size_t>(i)] * source[static_cast<std::size_t>(line * across + at * step)];
      }
      target[static_cast<std::size_t>(line * across + k * step)] = sum;
    }
}

}  // namespace

std::vector<float> shifted(const std::vector<float>& image, int pixels, const Eigen::Vector2d& shift)
{
  std::vector<float> result = image, source;
  for (const bool columns : {true, false})
  {
    const double along = columns ? shift.x() : shift.y();
    if (along == 0.0)
      continue;
    source = result;
    shiftLines(source, pixels, columns ? 1 : pixels, columns ? pixels : 1, along, result);
  }
  return result;
}

std::vector<float> logDifference(const std::vector<std::uint16_t>& counts, const std::vector<float>& mask, int pixels,
                                 const Eigen::Vector2d& shift)
{
  std::vector<float> difference = shifted(mask, pixels, shift);
  for (std::size_t k = 0; k < difference.size(); ++k)
    difference[k] = fastLog(std::max(static_cast<float>(counts[k]), kSmallestCount)) - difference[k];
  return difference;
}

}  // namespace endovascular_sim::fluoroscopy
