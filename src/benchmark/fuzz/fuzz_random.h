#pragma once

#include <cmath>
#include <cstdint>
#include <random>

namespace endovascular_sim::benchmark
{

/** Random numbers of one episode, identical on every machine, unlike the distributions of the standard library. */
class FuzzRandom
{
public:
  FuzzRandom(std::uint64_t seed, std::uint64_t episode) : engine_(seed * 0x9e3779b97f4a7c15ULL ^ (episode + 1))
  {
    engine_.discard(16);
  }

  /** Uniform in [0, 1). */
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  /** Uniform in the logarithm. @param low lower bound > 0 */
  double logBetween(double low, double high) { return low * std::pow(high / low, unit()); }
  int integer(int low, int high) { return low + static_cast<int>(unit() * (high - low + 1)); }  ///< bounds included
  bool chance(double probability) { return unit() < probability; }

private:
  std::mt19937_64 engine_;
};

}  // namespace endovascular_sim::benchmark
