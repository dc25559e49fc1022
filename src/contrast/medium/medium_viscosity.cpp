#include "contrast/medium/medium_viscosity.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace endovascular_sim::contrast
{
namespace
{

struct Medium
{
  double concentration;  // [kg/m³]
  double viscosity;      // [Pa·s]
};

constexpr std::array<Medium, 6> kMedia = {
    {{0.0, 0.69e-3}, {140.0, 1.5e-3}, {180.0, 2.0e-3}, {240.0, 3.4e-3}, {300.0, 6.3e-3}, {350.0, 10.4e-3}}};

}  // namespace

double mediumViscosity(double concentration)
{
  std::size_t k = 1;
  while (k + 1 < kMedia.size() && kMedia[k].concentration < concentration)
    ++k;
  const Medium &low = kMedia[k - 1], &high = kMedia[k];
  if (concentration == high.concentration)
    return high.viscosity;
  const double share = (concentration - low.concentration) / (high.concentration - low.concentration);
  return low.viscosity * std::pow(high.viscosity / low.viscosity, share);
}

}  // namespace endovascular_sim::contrast
