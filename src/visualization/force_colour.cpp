#include "visualization/force_colour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace endovascular_sim::visualization
{

Colour blend(const Colour& a, const Colour& b, float share)
{
  return {a.red + share * (b.red - a.red), a.green + share * (b.green - a.green), a.blue + share * (b.blue - a.blue)};
}

Colour forceColour(double force, double full_scale)
{
  const std::array<Colour, 4> stops{
      {{0.75F, 0.78F, 0.82F}, {1.0F, 0.90F, 0.20F}, {1.0F, 0.50F, 0.05F}, {0.85F, 0.05F, 0.05F}}};
  const double ratio = full_scale > 0.0 && std::isfinite(force) ? std::clamp(force / full_scale, 0.0, 1.0) : 0.0;
  const double position = ratio * static_cast<double>(stops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(position), stops.size() - 2);
  const auto share = static_cast<float>(position - static_cast<double>(below));
  return blend(stops[below], stops[below + 1], share);
}

}  // namespace endovascular_sim::visualization
