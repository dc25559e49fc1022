#pragma once

#include <cstdint>
#include <vector>

namespace endovascular_sim::fluoroscopy
{

/** Areal densities of iodine of the pixels that have some, in row-major order. */
struct IodineImage
{
  /** Areal density that changes the signal by less than 1e-5, and is left out [kg/m²]. */
  static constexpr double kLeast = 2e-6;

  std::vector<std::uint32_t> pixels;
  std::vector<float> densities;  ///< [kg/m²]

  void clear()
  {
    pixels.clear();
    densities.clear();
  }

  void add(std::size_t pixel, double density)
  {
    if (density < kLeast)
      return;
    pixels.push_back(static_cast<std::uint32_t>(pixel));
    densities.push_back(static_cast<float>(density));
  }
};

}  // namespace endovascular_sim::fluoroscopy
