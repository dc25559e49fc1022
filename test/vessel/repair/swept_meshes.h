#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

using Section = std::function<Eigen::Vector2d(double angle)>;  ///< point of a cross-section [m]

inline Section circle(double radius)
{
  return [radius](double angle) { return Eigen::Vector2d(radius * std::cos(angle), radius * std::sin(angle)); };
}

/** C-shaped cross-section between two circles, open over a share of the turn. */
inline Section crescent(double inner, double outer, double mouth)
{
  return [=](double angle)
  {
    const double turn = angle / (2.0 * M_PI);
    const bool is_outer = turn < 0.5;
    const double along = is_outer ? 2.0 * turn : 2.0 - 2.0 * turn;
    const double polar = M_PI * mouth + 2.0 * M_PI * (1.0 - mouth) * along;
    return Eigen::Vector2d((is_outer ? outer : inner) * Eigen::Vector2d(std::cos(polar), std::sin(polar)));
  };
}

inline std::vector<Eigen::Vector3d> straightLine(double length, int points = 40)
{
  std::vector<Eigen::Vector3d> line;
  for (int k = 0; k < points; ++k)
    line.emplace_back(0.0, 0.0, length * k / (points - 1));
  return line;
}

/** Points of a circle in the plane z = 0, over a part of the turn. */
inline std::vector<Eigen::Vector3d> arc(double radius, double angle, int points = 64)
{
  std::vector<Eigen::Vector3d> line;
  for (int k = 0; k < points; ++k)
    line.emplace_back(radius * std::cos(angle * k / points), radius * std::sin(angle * k / points), 0.0);
  return line;
}

/** Surface of a cross-section that moves along a line, normals outwards, without lids.
 *  @param ring true: the line is closed */
inline geometry::TriangleMesh sweep(const std::vector<Eigen::Vector3d>& line, const Section& section, bool ring = false,
                                    int around = 48)
{
  geometry::TriangleMesh mesh;
  const int n = static_cast<int>(line.size());
  const auto at = [&](int k) { return line[static_cast<std::size_t>(ring ? (k + n) % n : std::clamp(k, 0, n - 1))]; };
  Eigen::Vector3d u = (at(1) - at(0)).unitOrthogonal();
  for (int i = 0; i < n; ++i)
  {
    const Eigen::Vector3d tangent = (at(i + 1) - at(i - 1)).normalized();
    u = (u - u.dot(tangent) * tangent).normalized();
    for (int k = 0; k < around; ++k)
    {
      const Eigen::Vector2d p = section(2.0 * M_PI * k / around);
      mesh.vertices.emplace_back(at(i) + p.x() * u + p.y() * tangent.cross(u));
    }
  }
  for (int i = 0; i < (ring ? n : n - 1); ++i)
    for (int k = 0; k < around; ++k)
    {
      const int a = i * around + k;
      const int b = i * around + (k + 1) % around;
      const int up = (i + 1) % n * around;
      mesh.triangles.emplace_back(a, b, up + (k + 1) % around);
      mesh.triangles.emplace_back(a, up + (k + 1) % around, up + k);
    }
  return mesh;
}

/** Wall with a thickness around a round lumen, its inner and outer side joined at both ends. */
inline geometry::TriangleMesh thickWall(const std::vector<Eigen::Vector3d>& line, double inner, double outer)
{
  constexpr int kAround = 48;
  geometry::TriangleMesh mesh = sweep(line, circle(outer), false, kAround);
  const geometry::TriangleMesh lumen = sweep(line, circle(inner), false, kAround);
  const int offset = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), lumen.vertices.begin(), lumen.vertices.end());
  for (const Eigen::Vector3i& t : lumen.triangles)
    mesh.triangles.emplace_back(offset + t[0], offset + t[2], offset + t[1]);
  for (const int row : {0, static_cast<int>(line.size()) - 1})
    for (int k = 0; k < kAround; ++k)
    {
      const int a = row * kAround + k;
      const int b = row * kAround + (k + 1) % kAround;
      mesh.triangles.emplace_back(row == 0 ? b : a, row == 0 ? a : b, offset + b);
      mesh.triangles.emplace_back(row == 0 ? offset + b : a, row == 0 ? a : offset + b, offset + a);
    }
  return mesh;
}

}  // namespace endovascular_sim::vessel
