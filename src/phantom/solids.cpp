#include "phantom/solids.h"

#include <algorithm>
#include <utility>

namespace endovascular_sim::phantom
{

Solid ball(const Eigen::Vector3d& centre, double radius)
{
  return [centre, radius](const Eigen::Vector3d& p) { return (p - centre).norm() - radius; };
}

Solid ellipsoid(const Eigen::Vector3d& centre, const Eigen::Vector3d& semi_axes)
{
  const Eigen::Vector3d inverse = semi_axes.cwiseInverse();
  const double shortest = semi_axes.minCoeff();
  return [centre, inverse, shortest](const Eigen::Vector3d& p)
  { return ((p - centre).cwiseProduct(inverse).norm() - 1.0) * shortest; };
}

Solid ballChain(std::vector<Eigen::Vector3d> centres, double radius)
{
  return [centres = std::move(centres), radius](const Eigen::Vector3d& p)
  {
    double squared = 1e300;
    for (const Eigen::Vector3d& centre : centres)
      squared = std::min(squared, (p - centre).squaredNorm());
    return std::sqrt(squared) - radius;
  };
}

}  // namespace endovascular_sim::phantom
