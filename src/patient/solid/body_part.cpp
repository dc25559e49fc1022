#include "patient/solid/body_part.h"

#include <algorithm>

namespace endovascular_sim::patient
{

float BodyPart::distance(const Point& p) const
{
  float nearest = 1e6F;
  for (const SolidPointer& solid : solids)
    nearest = std::min(nearest, solid->distance(p));
  for (const SolidPointer& hole : holes)
    nearest = std::max(nearest, -hole->distance(p));
  return nearest;
}

}  // namespace endovascular_sim::patient
