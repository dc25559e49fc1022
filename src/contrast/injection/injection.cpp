#include "contrast/injection/injection.h"

#include <algorithm>
#include <cmath>

#include "common/text/format.h"

namespace endovascular_sim::contrast
{
namespace
{

constexpr double kRounding = 1e-9;    // relative, of a syringe's content
constexpr double kMillilitre = 1e-6;  // [m³]

bool isPositive(double value)
{
  return std::isfinite(value) && value > 0.0;
}

}  // namespace

double Injection::volumeAfter(double time) const
{
  if (time <= 0.0)
    return 0.0;
  const double given = time < rise ? 0.5 * rate * time * time / rise : rate * (time - 0.5 * rise);
  return std::min(given, volume);
}

double Injection::duration() const
{
  const double in_rise = 0.5 * rate * rise;
  return volume < in_rise ? std::sqrt(2.0 * volume * rise / rate) : volume / rate + 0.5 * rise;
}

std::string refusalOf(const Injection& injection, const Syringe& syringe, double left)
{
  const double volume = injection.volume, rate = injection.rate;
  if (!isPositive(volume))
    return formatted("volume is %g m³; must be a positive number", volume);
  if (volume > left * (1.0 + kRounding))
    return formatted("volume is %g ml, and the %s holds %g ml; inject less, or refill it", volume / kMillilitre,
                     syringe.name, left / kMillilitre);
  if (!isPositive(rate))
    return formatted("rate is %g m³/s; must be a positive number", rate);
  if (rate > syringe.fastest * (1.0 + kRounding))
    return formatted("rate is %g ml/s; a %s gives at most %g ml/s", rate / kMillilitre, syringe.name,
                     syringe.fastest / kMillilitre);
  if (!(injection.rise >= 0.0 && injection.rise <= kLongestRise))
    return formatted("rise is %g s; must be between 0 and %g s", injection.rise, kLongestRise);
  if (!isPositive(injection.concentration) || injection.concentration > kStrongestMedium)
    return formatted("concentration is %g kg/m³ (mgI/ml); must be above 0 and at most %g", injection.concentration,
                     kStrongestMedium);
  if (!(injection.viscosity >= kLeastViscosity && injection.viscosity <= kMostViscosity))
    return formatted("viscosity is %g Pa·s; must be between %g and %g Pa·s, e.g. 0.0104 for 350 mgI/ml at 37 °C",
                     injection.viscosity, kLeastViscosity, kMostViscosity);
  return "";
}

std::string refusalOf(const Injection& injection, const Syringe& syringe)
{
  return refusalOf(injection, syringe, syringe.capacity);
}

}  // namespace endovascular_sim::contrast
