#include "segmentation/lumen/local_lumen.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::segmentation
{
namespace
{

constexpr double kFarthestWall = 0.03;  ///< longest ray to the wall [m]

double toWall(const Scan& scan, const Eigen::Vector3d& p, const Eigen::Vector3d& direction, double threshold)
{
  for (double s = 0.0; s < kFarthestWall; s += 1e-4)
    if (scan.at(p + s * direction) < threshold)
      return s;
  return kFarthestWall;
}

}  // namespace

double quantile(std::vector<double>& values, double share)
{
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

std::vector<double> valuesAround(const Scan& scan, const Eigen::Vector3d& p, double pitch, int steps)
{
  std::vector<double> values;
  for (int c = -steps; c <= steps; ++c)
    for (int b = -steps; b <= steps; ++b)
      for (int a = -steps; a <= steps; ++a)
        values.push_back(scan.at(p + pitch * Eigen::Vector3d(a, b, c)));
  return values;
}

double localValue(const Scan& scan, const Eigen::Vector3d& p)
{
  std::vector<double> values = valuesAround(scan, p, 2.5e-4, 2);
  return quantile(values, 0.6);
}

std::vector<Eigen::Vector3d> directionsOfSphere(int count)
{
  std::vector<Eigen::Vector3d> directions;
  for (int k = 0; k < count; ++k)
  {
    const double z = 1.0 - (2.0 * k + 1.0) / count;
    const double angle = k * M_PI * (3.0 - std::sqrt(5.0));
    const double r = std::sqrt(1.0 - z * z);
    directions.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  return directions;
}

double lumenRadius(const Scan& scan, const Eigen::Vector3d& p, double threshold)
{
  double shortest = 2.0 * kFarthestWall;
  for (const Eigen::Vector3d& direction : directionsOfSphere(160))
    if (direction.z() >= 0.0)
      shortest = std::min(shortest, toWall(scan, p, direction, threshold) + toWall(scan, p, -direction, threshold));
  return 0.5 * shortest;
}

}  // namespace endovascular_sim::segmentation
