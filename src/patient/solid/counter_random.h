#pragma once

#include <cstdint>

#include "common/numerics/counter_hash.h"

namespace endovascular_sim::patient
{

/** Random numbers that are functions of seed, stream and counter: equal on all machines, and a stream does not change
 * when another one takes more numbers. */
class CounterRandom
{
public:
  CounterRandom(std::uint64_t seed, std::uint64_t stream) : key_(mixedBits(seed ^ mixedBits(stream))) {}

  /** Uniform in [low, high). */
  float uniform(float low, float high)
  {
    const auto bits = static_cast<float>(mixedBits(key_ + counter_++) >> 40);
    return low + (high - low) * bits * (1.0F / 16777216.0F);
  }

  /** Mean 0 and standard deviation 1, bounded: the sum of 12 uniform numbers. */
  float normal()
  {
    float sum = -6.0F;
    for (int i = 0; i < 12; ++i)
      sum += uniform(0.0F, 1.0F);
    return sum;
  }

private:
  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

}  // namespace endovascular_sim::patient
