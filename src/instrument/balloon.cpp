#include "instrument/balloon.h"

namespace endovascular_sim::instrument
{
namespace
{

double onLine(const Balloon::Compliance& a, const Balloon::Compliance& b, double pressure)
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
    // The last row is not left: its segment goes on beyond it.
    if (pressure <= above.pressure || &above == &compliance.back())
      return onLine(below, above, pressure);
    below = above;
  }
  return folded_diameter;
}

}  // namespace endovascular_sim::instrument
