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

}  // namespace endovascular_sim::fluoroscopy
