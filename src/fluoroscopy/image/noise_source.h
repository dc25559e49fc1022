#pragma once

#include <cstdint>

#include "common/numerics/counter_hash.h"

namespace endovascular_sim::fluoroscopy
{

/** Standard normal numbers that are a function of seed, frame and pixel, so that frames can be drawn in any order and
 * equal seeds give equal bits. Two numbers per pixel: Box–Muller transform of two hashes of 24 bits. */
class NoiseSource
{
public:
  NoiseSource(std::uint64_t seed, std::uint64_t frame);

  /** Fills two independent sequences.
   *  @param first pixel index of the first number */
  void fill(std::uint32_t first, int count, float* a, float* b) const;

private:
  CounterKeys keys_;
};

}  // namespace endovascular_sim::fluoroscopy
