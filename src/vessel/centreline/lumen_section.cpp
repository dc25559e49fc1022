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

double equalAreaDiameter(const std::vector<double>& reaches)
{
  std::vector<double> reach = reaches;
  const std::size_t rays = reach.size();
  const auto middle = reach.begin() + static_cast<std::ptrdiff_t>(rays / 2);
  std::nth_element(reach.begin(), middle, reach.end());
  const double median = *middle;
  for (std::size_t k = 0; k < rays; ++k)
    reach[k] = reaches[k] > kSideBranch * median ? median : reaches[k];
  const double step = 2.0 * M_PI / static_cast<double>(rays), sine = std::sin(step);
  double area = 0.0;  // of the polygon through the hits
  for (std::size_t k = 0; k < rays; ++k)
    area += 0.5 * reach[k] * reach[k + 1 < rays ? k + 1 : 0] * sine;
  // Ratio of the areas of an inscribed regular polygon and its circle.
  const double inscribed = sine / step;
  return 2.0 * std::sqrt(area / inscribed / M_PI);
}

double lumenDiameter(const geometry::MeshDistance& wall, const Eigen::Vector3d& centre, const Eigen::Vector3d& axis,
                     int rays)
{
  const Eigen::Vector3d u = axis.unitOrthogonal();
  const Eigen::Vector3d v = axis.cross(u);
  const double step = 2.0 * M_PI / rays;
  std::vector<double> reaches;
  for (int k = 0; k < rays; ++k)
  {
    const double hit = wall.rayHit(centre, std::cos(k * step) * u + std::sin(k * step) * v);
    reaches.push_back(hit < 0.0 ? kNoHit : hit);
  }
  return equalAreaDiameter(reaches);
}

}  // namespace endovascular_sim::vessel
