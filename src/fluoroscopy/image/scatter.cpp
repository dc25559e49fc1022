#include "fluoroscopy/image/scatter.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kOpenRatio = 2.6;    // without grid, for the reference thickness and a large field
constexpr double kReference = 200.0;  // areal density of water [kg/m²]
constexpr double kExponent = 1.3;
constexpr double kField = 0.16;       // [m]
constexpr double kGrid = 0.12 / 0.7;  // transmission of scatter / primary
constexpr double kSpread = 0.03;      // standard deviation at the detector [m]
constexpr float kSmallest = 1e-30F;   // avoids an infinite logarithm

}  // namespace

double scatterToPrimary(double thickness, double field)
{
  return kGrid * kOpenRatio * std::pow(std::max(thickness, 0.0) / kReference, kExponent) *
         (1.0 - std::exp(-field / kField));
}

void scatter(CoarseImage& image, const WaterEquivalent& water, double width, int pixels, double field)
{
  for (float& value : image.values())
  {
    const double thickness = water.thickness(std::log(static_cast<double>(std::max(value, kSmallest))));
    value *= static_cast<float>(scatterToPrimary(thickness, field));
  }
  image.blur(kSpread / width * pixels, false);
}

}  // namespace endovascular_sim::fluoroscopy
