#include "vessel/centreline/lumen_section.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

namespace endovascular_sim::vessel
{
namespace
{

constexpr double kSideBranch = 1.5;  // ratio to the median beyond which a ray has entered a side branch

}  // namespace

double lumenDiameter(const geometry::MeshDistance& wall, const Eigen::Vector3d& centre, const Eigen::Vector3d& axis,
                     int rays)
{
  const Eigen::Vector3d u = axis.unitOrthogonal();
  const Eigen::Vector3d v = axis.cross(u);
  const double step = 2.0 * M_PI / rays;
  std::vector<double> reach;
  for (int k = 0; k < rays; ++k)
  {
    const double hit = wall.rayHit(centre, std::cos(k * step) * u + std::sin(k * step) * v);
    reach.push_back(hit < 0.0 ? 1e300 : hit);
  }
  std::vector<double> sorted = reach;
  std::sort(sorted.begin(), sorted.end());
  const double median = sorted[sorted.size() / 2];
  for (double& r : reach)
    r = r > kSideBranch * median ? median : r;
  double area = 0.0;  // of the polygon through the hits
  for (std::size_t k = 0; k < reach.size(); ++k)
    area += 0.5 * reach[k] * reach[(k + 1) % reach.size()] * std::sin(step);
  // Ratio of the areas of an inscribed regular polygon and its circle.
  const double inscribed = std::sin(step) / step;
  return 2.0 * std::sqrt(area / inscribed / M_PI);
}

}  // namespace endovascular_sim::vessel
