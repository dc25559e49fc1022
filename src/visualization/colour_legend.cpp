#include "visualization/colour_legend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <locale>
#include <sstream>

namespace endovascular_sim::visualization
{

double roundFullScale(double value, double smallest)
{
  if (!std::isfinite(value) || value <= smallest)
    return smallest;
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0})
    if (value <= step * decade * (1.0 + 1e-9))
      return step * decade;
  return 10.0 * decade;
}

LegendScale legendScale(double full, const std::string& unit)
{
  struct Prefix
  {
    const char* name;
    double factor;
  };
  constexpr std::array<Prefix, 3> kPrefixes{{{"", 1.0}, {"m", 1e3}, {"µ", 1e6}}};
  const double scale = std::isfinite(full) && full > 0.0 ? full : 1.0;
  const auto* prefix = std::find_if(kPrefixes.begin(), kPrefixes.end() - 1,
                                    [&](const Prefix& candidate) { return scale * candidate.factor >= 0.999; });
  // Full scales of 1 and 5 times a power of ten have five parts, those of 2 four.
  const double leading = scale / std::pow(10.0, std::floor(std::log10(scale) + 1e-9));
  const int parts = std::abs(leading - 2.0) < 1e-6 ? 4 : 5;
  LegendScale legend;
  legend.full = scale;
  legend.unit = prefix->name + unit;
  for (int k = 0; k <= parts; ++k)
  {
    legend.ticks.push_back(scale * k / parts);
    std::ostringstream label;
    label.imbue(std::locale::classic());
    label.precision(3);
    label << legend.ticks.back() * prefix->factor;
    legend.labels.push_back(label.str());
  }
  return legend;
}

bool FollowingScale::follow(double largest)
{
  const double wanted = std::max(full_, roundFullScale(largest, smallest_));
  const bool has_changed = wanted != full_;
  full_ = wanted;
  return has_changed;
}

}  // namespace endovascular_sim::visualization
