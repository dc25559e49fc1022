#pragma once

#include <vector>

namespace endovascular_sim::fluoroscopy
{

/** Areal densities along the rays of a square image [kg/m²], in row-major order from the top left. */
struct ArealDensityImage
{
  int samples = 0;  ///< rays per side
  std::vector<float> tissue;
  std::vector<float> bone;
};

/** Image without densities. */
ArealDensityImage emptyImage(int samples);

/** Bilinear interpolation to @p pixels × @p pixels; constant beyond the outermost samples. Equal sizes return the
 * image. */
ArealDensityImage resampled(const ArealDensityImage& image, int pixels);

/** Adds a signed change of areal densities, interpolated in the same way; no density falls below zero.
 *  @param change samples × samples numbers [kg/m²]
 *  @param densities pixels × pixels numbers [kg/m²] */
void addResampled(const std::vector<float>& change, int samples, int pixels, std::vector<float>& densities);

}  // namespace endovascular_sim::fluoroscopy
