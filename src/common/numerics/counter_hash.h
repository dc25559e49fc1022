#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace endovascular_sim
{

/** Finaliser of SplitMix64 (G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014). */
inline std::uint64_t mixedBits(std::uint64_t value)
{
  value += 0x9e3779b97f4a7c15ULL;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

/** Bijective hash of 32 bits with low bias (C. Wellons' lowbias32). */
inline std::uint32_t mixedBits32(std::uint32_t x)
{
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  return x ^ (x >> 16);
}

/** Keys of the numbers of a stream. */
using CounterKeys = std::array<std::uint32_t, 4>;

/** Keys from seed and stream by SplitMix64. */
inline CounterKeys counterKeys(std::uint64_t seed, std::uint64_t stream)
{
  std::uint64_t state = mixedBits(seed) ^ (stream * 0xd1342543de82ef95ULL);
  CounterKeys keys{};
  for (std::size_t k = 0; k < keys.size(); k += 2)
  {
    const std::uint64_t bits = mixedBits(state);
    state += 0x9e3779b97f4a7c15ULL;
    keys[k] = static_cast<std::uint32_t>(bits);
    keys[k + 1] = static_cast<std::uint32_t>(bits >> 32);
  }
  return keys;
}

/** Uniform number in [0, 1) that is a function of seed, stream and index. */
inline double uniformNumber(std::uint64_t seed, std::uint64_t stream, std::uint64_t index)
{
  return std::ldexp(static_cast<double>(mixedBits(mixedBits(seed ^ mixedBits(stream)) ^ index) >> 11), -53);
}

}  // namespace endovascular_sim
