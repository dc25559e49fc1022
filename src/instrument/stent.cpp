#include "instrument/stent.h"

namespace endovascular_sim::instrument
{

double Stent::lengthAt(double diameter) const
{
  if (diameter <= expansion.front().diameter)
    return expansion.front().length;
  for (std::size_t k = 1; k < expansion.size(); ++k)
  {
    const Expansion& a = expansion[k - 1];
    const Expansion& b = expansion[k];
    if (diameter <= b.diameter)
      return a.length + (b.length - a.length) * ((diameter - a.diameter) / (b.diameter - a.diameter));
  }
  return expansion.back().length;
}

}  // namespace endovascular_sim::instrument
