#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::fluoroscopy
{

/** Sphere of @p rows rings with @p columns facets, outward oriented [m]. */
inline geometry::TriangleMesh sphere(const Eigen::Vector3d& centre, double radius, int rows, int columns)
{
  geometry::TriangleMesh mesh;
  mesh.vertices.emplace_back(centre + radius * Eigen::Vector3d::UnitZ());
  for (int i = 1; i < rows; ++i)
    for (int j = 0; j < columns; ++j)
    {
      const double theta = M_PI * i / rows, phi = 2.0 * M_PI * j / columns;
      mesh.vertices.emplace_back(centre + radius * Eigen::Vector3d(std::sin(theta) * std::cos(phi),
                                                                   std::sin(theta) * std::sin(phi), std::cos(theta)));
    }
  mesh.vertices.emplace_back(centre - radius * Eigen::Vector3d::UnitZ());
  const int last = static_cast<int>(mesh.vertices.size()) - 1;
  const auto at = [&](int i, int j) { return 1 + (i - 1) * columns + j % columns; };
  for (int j = 0; j < columns; ++j)
  {
    mesh.triangles.emplace_back(0, at(1, j), at(1, j + 1));
    for (int i = 1; i + 1 < rows; ++i)
    {
      mesh.triangles.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      mesh.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
    mesh.triangles.emplace_back(at(rows - 1, j), last, at(rows - 1, j + 1));
  }
  return mesh;
}

/** Closed cylinder from @p a to @p b with @p columns facets, outward oriented [m]. */
inline geometry::TriangleMesh cylinder(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius, int columns)
{
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), b - a);
  geometry::TriangleMesh mesh;
  mesh.vertices = {a, b};
  for (int j = 0; j < columns; ++j)
  {
    const double phi = 2.0 * M_PI * j / columns;
    const Eigen::Vector3d rim = turn * Eigen::Vector3d(radius * std::cos(phi), radius * std::sin(phi), 0.0);
    mesh.vertices.emplace_back(a + rim);
    mesh.vertices.emplace_back(b + rim);
  }
  for (int j = 0; j < columns; ++j)
  {
    const int a0 = 2 + 2 * j, a1 = 2 + 2 * ((j + 1) % columns), b0 = a0 + 1, b1 = a1 + 1;
    mesh.triangles.emplace_back(a0, a1, b1);
    mesh.triangles.emplace_back(a0, b1, b0);
    mesh.triangles.emplace_back(0, a1, a0);
    mesh.triangles.emplace_back(1, b0, b1);
  }
  return mesh;
}

/** Chord of the ray s + t·d in a sphere [m]. */
inline double chordInSphere(const Eigen::Vector3d& s, const Eigen::Vector3d& d, const Eigen::Vector3d& centre,
                            double radius)
{
  const double distance = d.cross(centre - s).norm() / d.norm();
  return distance < radius ? 2.0 * std::sqrt(radius * radius - distance * distance) : 0.0;
}

}  // namespace endovascular_sim::fluoroscopy
