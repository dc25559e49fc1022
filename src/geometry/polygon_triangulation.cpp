#include "geometry/polygon_triangulation.h"

#include <cstddef>

#include <Eigen/Geometry>

namespace endovascular_sim::geometry
{
namespace
{

const Eigen::Vector3d& at(const std::vector<Eigen::Vector3d>& positions, int index)
{
  return positions[static_cast<std::size_t>(index)];
}

/** Twice the signed area of a triangle projected along a direction. */
double projectedArea(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                     const Eigen::Vector3d& direction)
{
  return (b - a).cross(c - a).dot(direction);
}

/** True when corner k of a polygon is convex and no other corner lies in its triangle. */
bool isEar(const std::vector<int>& ring, std::size_t k, const std::vector<Eigen::Vector3d>& positions,
           const Eigen::Vector3d& normal)
{
  const std::size_t n = ring.size();
  const int before = ring[(k + n - 1) % n];
  const int after = ring[(k + 1) % n];
  const Eigen::Vector3d& a = at(positions, before);
  const Eigen::Vector3d& b = at(positions, ring[k]);
  const Eigen::Vector3d& c = at(positions, after);
  if (projectedArea(a, b, c, normal) <= 0.0)
    return false;
  for (const int other : ring)
  {
    if (other == before || other == ring[k] || other == after)
      continue;
    const Eigen::Vector3d& p = at(positions, other);
    if (projectedArea(a, b, p, normal) >= 0.0 && projectedArea(b, c, p, normal) >= 0.0 &&
        projectedArea(c, a, p, normal) >= 0.0)
      return false;
  }
  return true;
}

}  // namespace

Eigen::Vector3d newellNormal(const std::vector<int>& ring, const std::vector<Eigen::Vector3d>& positions)
{
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  const Eigen::Vector3d& first = at(positions, ring[0]);
  for (std::size_t k = 1; k + 1 < ring.size(); ++k)
    normal += (at(positions, ring[k]) - first).cross(at(positions, ring[k + 1]) - first);
  return normal;
}

std::vector<Eigen::Vector3i> triangulatePolygon(std::vector<int> ring, const std::vector<Eigen::Vector3d>& positions)
{
  std::vector<Eigen::Vector3i> triangles;
  const Eigen::Vector3d normal = newellNormal(ring, positions);
  std::size_t k = 0;
  std::size_t rejected = 0;
  while (ring.size() > 3)
  {
    const std::size_t n = ring.size();
    k %= n;
    if (rejected < n && !isEar(ring, k, positions, normal))
    {
      ++k;
      ++rejected;
      continue;
    }
    triangles.emplace_back(ring[(k + n - 1) % n], ring[k], ring[(k + 1) % n]);
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(k));
    rejected = 0;
  }
  triangles.emplace_back(ring[0], ring[1], ring[2]);
  return triangles;
}

}  // namespace endovascular_sim::geometry
