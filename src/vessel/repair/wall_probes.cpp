#include "vessel/repair/wall_probes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

namespace endovascular_sim::vessel
{
namespace
{

constexpr int kProbes = 400;
constexpr double kOff = 1e-5;  // distance of a ray's origin from the wall, in roots of the triangle's area

/** Points that fill a square evenly: multiples of the powers of the plastic number (M. Roberts, 2018). */
Eigen::Vector2d evenPoint(int k)
{
  constexpr double kFirst = 0.7548776662466927;
  constexpr double kSecond = 0.5698402909980532;
  const double a = 0.5 + kFirst * k;
  const double b = 0.5 + kSecond * k;
  return {a - std::floor(a), b - std::floor(b)};
}

Eigen::Vector3d pointOf(const geometry::TriangleMesh& mesh, const Eigen::Vector3i& t, int k)
{
  Eigen::Vector2d weight = evenPoint(k);
  if (weight.sum() > 1.0)
    weight = Eigen::Vector2d::Ones() - weight;
  const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[0])];
  return a + weight[0] * (mesh.vertices[static_cast<std::size_t>(t[1])] - a) +
         weight[1] * (mesh.vertices[static_cast<std::size_t>(t[2])] - a);
}

/** Vector area of a triangle, times two [m²]. */
Eigen::Vector3d areaOf(const geometry::TriangleMesh& mesh, const Eigen::Vector3i& t)
{
  const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[0])];
  return (mesh.vertices[static_cast<std::size_t>(t[1])] - a).cross(mesh.vertices[static_cast<std::size_t>(t[2])] - a);
}

/** Distance from a point of the wall to the next wall along a direction [m]; −1: none. */
double sight(const geometry::MeshDistance& distance, const Eigen::Vector3d& point, const Eigen::Vector3d& direction,
             double off)
{
  const double hit = distance.rayHit(point + off * direction, direction);
  return hit < 0.0 ? -1.0 : hit + off;
}

}  // namespace

std::vector<WallProbe> probeWall(const geometry::TriangleMesh& mesh, const geometry::MeshDistance& distance)
{
  double total = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles)
    total += areaOf(mesh, t).norm();
  std::vector<WallProbe> probes;
  double passed = 0.0;
  int k = 0;
  for (const Eigen::Vector3i& t : mesh.triangles)
  {
    const Eigen::Vector3d area = areaOf(mesh, t);
    passed += area.norm();
    for (; area.norm() > 0.0 && k < kProbes && (k + 0.5) * total < kProbes * passed; ++k)
    {
      WallProbe probe;
      probe.point = pointOf(mesh, t, k);
      probe.inward = -area.normalized();
      const double off = kOff * std::sqrt(area.norm());
      probe.across = sight(distance, probe.point, probe.inward, off);
      probe.outside = sight(distance, probe.point, -probe.inward, off);
      probes.push_back(probe);
    }
  }
  return probes;
}

double lumenWidth(const std::vector<WallProbe>& probes)
{
  std::vector<double> widths;
  for (const WallProbe& probe : probes)
    if (const double width = probe.across > 0.0 ? probe.across : probe.outside; width > 0.0)
      widths.push_back(width);
  if (widths.empty())
    return 0.0;
  const auto quartile = widths.begin() + static_cast<std::ptrdiff_t>(3 * widths.size() / 4);
  std::nth_element(widths.begin(), quartile, widths.end());
  return *quartile;
}

}  // namespace endovascular_sim::vessel
