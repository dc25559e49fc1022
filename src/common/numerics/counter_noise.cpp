#include "common/numerics/counter_noise.h"

#include <cmath>

namespace endovascular_sim
{
CounterNoise::CounterNoise(std::uint64_t seed, std::uint64_t stream) : keys_(counterKeys(seed, stream)) {}

void CounterNoise::fill(std::uint32_t first, int count, float* a, float* b) const
{
  constexpr double kUnit = 1.0 / 16777216.0;
  for (int i = 0; i < count; ++i)
  {
    const std::uint32_t counter = (first + static_cast<std::uint32_t>(i)) * 0x9e3779b9U;
    const std::uint32_t h = mixedBits32(mixedBits32(counter + keys_[0]) ^ keys_[1]);
    const std::uint32_t g = mixedBits32(mixedBits32(h + keys_[2]) ^ keys_[3]);
    const double u = static_cast<double>((h >> 8) + 1) * kUnit;  // in (0, 1]
    const double v = static_cast<double>(g >> 8) * kUnit;        // in [0, 1)
    const double radius = std::sqrt(-2.0 * std::log(u));
    a[i] = static_cast<float>(radius * std::cos(2.0 * M_PI * v));
    b[i] = static_cast<float>(radius * std::sin(2.0 * M_PI * v));
  }
}

}  // namespace endovascular_sim
