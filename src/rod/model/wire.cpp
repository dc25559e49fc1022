#include "rod/model/wire.h"

namespace endovascular_sim::rod
{

double Wire::length() const
{
  double sum = 0.0;
  for (const Section& section : sections)
    sum += section.length;
  return sum;
}

double Wire::curvedTipLength() const
{
  std::size_t first = 0;
  while (first < sections.size() && sections[first].rest_curvature.isZero(0.0))
    ++first;
  double sum = 0.0;
  for (; first < sections.size(); ++first)
    sum += sections[first].length;
  return sum;
}

double Wire::radiusAt(double position) const
{
  double end = 0.0;
  for (const Section& section : sections)
  {
    end += section.length;
    if (position <= end)
      return section.radius;
  }
  return sections.back().radius;
}

}  // namespace endovascular_sim::rod
