#include "contact/wall/wall_law.h"

namespace endovascular_sim::contact
{

double WallLaw::frictionAt(const Eigen::Vector3d& point) const
{
  for (auto region = regions.rbegin(); region != regions.rend(); ++region)
    if ((point - region->centre).squaredNorm() <= region->radius * region->radius)
      return region->friction;
  return friction;
}

}  // namespace endovascular_sim::contact
