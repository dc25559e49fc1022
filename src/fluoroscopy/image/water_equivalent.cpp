#include "fluoroscopy/image/water_equivalent.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::fluoroscopy
{
namespace
{

constexpr double kStep = 5.0;  // areal density of water between the nodes [kg/m²]
constexpr int kNodes = 121;

}  // namespace

WaterEquivalent::WaterEquivalent(const Beam& beam)
{
  const EnergyTable water = massAttenuationTable({{"Water, Liquid", 1.0}});
  for (int k = 0; k < kNodes; ++k)
  {
    double signal = 0.0;
    for (const double part : filtered(beam.signal(), water, kStep * k))
      signal += part;
    log_signal_.push_back(std::log(signal));
    log_kerma_.push_back(std::log(airKerma(filtered(beam.detector(), water, kStep * k))));
  }
}

double WaterEquivalent::interpolate(const std::vector<double>& values, double thickness)
{
  const double x = std::clamp(thickness / kStep, 0.0, kNodes - 1.0);
  const auto cell = std::min<std::size_t>(static_cast<std::size_t>(x), kNodes - 2);
  const double weight = x - static_cast<double>(cell);
  return values[cell] + weight * (values[cell + 1] - values[cell]);
}

double WaterEquivalent::thickness(double log_signal) const
{
  // The signal decreases with the thickness.
  auto above = std::lower_bound(log_signal_.begin(), log_signal_.end(), log_signal,
                                [](double node, double value) { return node > value; });
  above = std::clamp(above, log_signal_.begin() + 1, log_signal_.end() - 1);
  const double before = *(above - 1), after = *above;
  const double weight = std::clamp((before - log_signal) / (before - after), 0.0, 1.0);
  return kStep * (static_cast<double>(above - log_signal_.begin()) - 1.0 + weight);
}

double WaterEquivalent::detectorKerma(double thickness) const
{
  return std::exp(interpolate(log_kerma_, thickness));
}

}  // namespace endovascular_sim::fluoroscopy
