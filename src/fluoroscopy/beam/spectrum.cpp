#include "fluoroscopy/beam/spectrum.h"

#include <cmath>

namespace endovascular_sim::fluoroscopy
{
namespace
{

const EnergyTable& airEnergyAbsorption()
{
  static const EnergyTable table = []
  {
    EnergyTable values{};
    for (std::size_t e = kLowestEnergy; e < kEnergies; ++e)
      values[e] = massEnergyAbsorption({{"Air, Dry (near sea level)", 1.0}}, static_cast<double>(e));
    return values;
  }();
  return table;
}

}  // namespace

EnergyTable massAttenuationTable(const Composition& composition)
{
  EnergyTable values{};
  for (std::size_t e = kLowestEnergy; e < kEnergies; ++e)
    values[e] = massAttenuation(composition, static_cast<double>(e));
  return values;
}

Spectrum filtered(const Spectrum& spectrum, const EnergyTable& mass, double areal_density)
{
  Spectrum result = spectrum;
  for (std::size_t e = kLowestEnergy; e < kEnergies; ++e)
    if (result[e] > 0.0)
      result[e] *= std::exp(-mass[e] * areal_density);
  return result;
}

double airKerma(const Spectrum& spectrum)
{
  const EnergyTable& air = airEnergyAbsorption();
  double sum = 0.0;
  for (std::size_t e = kLowestEnergy; e < kEnergies; ++e)
    sum += spectrum[e] * static_cast<double>(e) * air[e];
  return sum * kJoulePerKev;
}

double halfValueLayer(const Spectrum& spectrum, const Composition& composition, double density, double fraction)
{
  const EnergyTable mass = massAttenuationTable(composition);
  const double wanted = fraction * airKerma(spectrum);
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i)
  {
    const double middle = 0.5 * (low + high);
    (airKerma(filtered(spectrum, mass, density * middle)) > wanted ? low : high) = middle;
  }
  return low;
}

}  // namespace endovascular_sim::fluoroscopy
