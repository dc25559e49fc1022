#include "common/numerics/counter_noise.h"

#include <cmath>

namespace endovascular_sim
{
namespace
{

/** SplitMix64 (S. Vigna): keys from seed and stream. */
std::uint64_t splitMix(std::uint64_t& state)
{
  state += 0x9e3779b97f4a7c15ULL;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/** Bijective hash of 32 bits with low bias (C. Wellons' lowbias32). */
std::uint32_t mix(std::uint32_t x)
{
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  return x ^ (x >> 16);
}

}  // namespace

CounterNoise::CounterNoise(std::uint64_t seed, std::uint64_t stream)
{
  std::uint64_t state = seed;
  state = splitMix(state) ^ (stream * 0xd1342543de82ef95ULL);
  for (int k = 0; k < 4; k += 2)
  {
    const std::uint64_t bits = splitMix(state);
    keys_[k] = static_cast<std::uint32_t>(bits);
    keys_[k + 1] = static_cast<std::uint32_t>(bits >> 32);
  }
}

void CounterNoise::fill(std::uint32_t first, int count, float* a, float* b) const
{
  constexpr double kUnit = 1.0 / 16777216.0;
  for (int i = 0; i < count; ++i)
  {
    const std::uint32_t counter = (first + static_cast<std::uint32_t>(i)) * 0x9e3779b9U;
    const std::uint32_t h = mix(mix(counter + keys_[0]) ^ keys_[1]);
    const std::uint32_t g = mix(mix(h + keys_[2]) ^ keys_[3]);
    const double u = static_cast<double>((h >> 8) + 1) * kUnit;  // in (0, 1]
    const double v = static_cast<double>(g >> 8) * kUnit;        // in [0, 1)
    const double radius = std::sqrt(-2.0 * std::log(u));
    a[i] = static_cast<float>(radius * std::cos(2.0 * M_PI * v));
    b[i] = static_cast<float>(radius * std::sin(2.0 * M_PI * v));
  }
}

}  // namespace endovascular_sim
