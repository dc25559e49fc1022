#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Cylinder with flat caps. */
struct Cylinder
{
  Eigen::Vector3d from;  ///< [m]
  Eigen::Vector3d to;    ///< [m]
  double radius;         ///< [m]

  /** Exact signed distance [m], negative inside. */
  double distance(const Eigen::Vector3d& p) const
  {
    const Eigen::Vector3d along = (to - from).normalized();
    const double s = (p - from).dot(along);
    const double side = (p - from - s * along).norm() - radius;
    const double cap = std::max(-s, s - (to - from).norm());
    const double outside = std::hypot(std::max(side, 0.0), std::max(cap, 0.0));
    return outside + std::min(std::max(side, cap), 0.0);
  }

  /** Closed, outward oriented mesh with vertices on the cylinder. */
  geometry::TriangleMesh mesh(int around, int rows) const
  {
    const Eigen::Vector3d along = (to - from).normalized();
    const Eigen::Vector3d u = along.unitOrthogonal();
    const Eigen::Vector3d w = along.cross(u);
    geometry::TriangleMesh mesh;
    mesh.vertices = {from, to};
    for (int j = 0; j <= rows; ++j)
      for (int k = 0; k < around; ++k)
      {
        const double angle = 2.0 * M_PI * k / around;
        mesh.vertices.emplace_back(from + j * (to - from) / rows +
                                   radius * (std::cos(angle) * u + std::sin(angle) * w));
      }
    const auto at = [around](int j, int k) { return 2 + j * around + k % around; };
    for (int k = 0; k < around; ++k)
    {
      mesh.triangles.emplace_back(0, at(0, k + 1), at(0, k));
      mesh.triangles.emplace_back(1, at(rows, k), at(rows, k + 1));
      for (int j = 0; j < rows; ++j)
      {
        mesh.triangles.emplace_back(at(j, k), at(j, k + 1), at(j + 1, k + 1));
        mesh.triangles.emplace_back(at(j, k), at(j + 1, k + 1), at(j + 1, k));
      }
    }
    return mesh;
  }
};

/** Signed distance to the union: exact outside, a bound inside. */
inline double unionDistance(const std::vector<Cylinder>& parts, const Eigen::Vector3d& p)
{
  double distance = 1e300;
  for (const Cylinder& part : parts)
    distance = std::min(distance, part.distance(p));
  return distance;
}

/** Largest unsigned distance of vertices and triangle centroids from the surface of the union. */
inline double largestDistance(const geometry::TriangleMesh& mesh, const std::vector<Cylinder>& parts)
{
  double largest = 0.0;
  for (const Eigen::Vector3d& v : mesh.vertices)
    largest = std::max(largest, std::abs(unionDistance(parts, v)));
  for (const Eigen::Vector3i& t : mesh.triangles)
  {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k)
      centre += mesh.vertices[static_cast<std::size_t>(t[k])] / 3.0;
    largest = std::max(largest, std::abs(unionDistance(parts, centre)));
  }
  return largest;
}

inline Eigen::Vector3d centreOf(const geometry::TriangleMesh& mesh, const Eigen::Vector3i& t)
{
  return (mesh.vertices[static_cast<std::size_t>(t[0])] + mesh.vertices[static_cast<std::size_t>(t[1])] +
          mesh.vertices[static_cast<std::size_t>(t[2])]) /
         3.0;
}

}  // namespace endovascular_sim::vessel
