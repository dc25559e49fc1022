#include "instrument/balloon.h"

namespace endovascular_sim::instrument
{
namespace
{

double interpolate(const Balloon::Compliance& a, const Balloon::Compliance& b, double pressure)
{
  return a.diameter + (b.diameter - a.diameter) * ((pressure - a.pressure) / (b.pressure - a.pressure));
}

}  // namespace

double Balloon::diameterAt(double pressure) const
{
  if (pressure <= 0.0 || compliance.empty())
    return folded_diameter;
  Balloon::Compliance below{0.0, folded_diameter};
  for (const Compliance& above : compliance)
  {
    // Pressures beyond the last row are extrapolated with its segment.
    if (pressure <= above.pressure || &above == &compliance.back())
      return interpolate(below, above, pressure);
    below = above;
  }
  return folded_diameter;
}

}  // namespace endovascular_sim::instrument
