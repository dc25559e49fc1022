#pragma once

#include <cstdint>

#include "common/numerics/counter_hash.h"

namespace endovascular_sim
{

/** Standard normal numbers that are a function of seed, stream and index, so that they can be drawn in any order. Two
 *  numbers per index: Box–Muller transform of two hashes of 24 bits. */
class CounterNoise
{
public:
  CounterNoise(std::uint64_t seed, std::uint64_t stream);

  /** Fills two independent sequences.
   *  @param first index of the first number */
  void fill(std::uint32_t first, int count, float* a, float* b) const;

private:
  CounterKeys keys_;
};

}  // namespace endovascular_sim
