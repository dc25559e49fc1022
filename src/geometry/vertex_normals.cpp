#include "geometry/vertex_normals.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace endovascular_sim::geometry
{

std::vector<Eigen::Vector3d> vertexNormals(const TriangleMesh& mesh)
{
  std::vector<Eigen::Vector3d> normals(mesh.vertices.size(), Eigen::Vector3d::Zero());
  for (const Eigen::Vector3i& t : mesh.triangles)
  {
    const auto at = [&](int k) -> const Eigen::Vector3d& { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    const Eigen::Vector3d area = (at(1) - at(0)).cross(at(2) - at(0));
    for (int k = 0; k < 3; ++k)
      normals[static_cast<std::size_t>(t[k])] += area;
  }
  for (Eigen::Vector3d& normal : normals)
    normal = normal.norm() > 0.0 ? Eigen::Vector3d(normal.normalized()) : Eigen::Vector3d::UnitZ();
  return normals;
}

std::vector<Eigen::Vector3d> angleWeightedNormals(const TriangleMesh& mesh)
{
  std::vector<Eigen::Vector3d> normals(mesh.vertices.size(), Eigen::Vector3d::Zero());
  for (const Eigen::Vector3i& t : mesh.triangles)
  {
    std::array<Eigen::Vector3d, 3> side;  // unit, from each corner to the next
    for (std::size_t k = 0; k < 3; ++k)
      side[k] = (mesh.vertices[static_cast<std::size_t>(t[static_cast<int>((k + 1) % 3)])] -
                 mesh.vertices[static_cast<std::size_t>(t[static_cast<int>(k)])])
                    .normalized();
    const Eigen::Vector3d facet = side[0].cross(side[1]).normalized();
    for (std::size_t k = 0; k < 3; ++k)
      normals[static_cast<std::size_t>(t[static_cast<int>(k)])] +=
          std::acos(std::clamp(-side[k].dot(side[(k + 2) % 3]), -1.0, 1.0)) * facet;
  }
  for (Eigen::Vector3d& normal : normals)
    normal.normalize();
  return normals;
}

Eigen::Vector3d barycentric(const TriangleMesh& mesh, const ClosestPoint& at)
{
  const Eigen::Vector3i& t = mesh.triangles[static_cast<std::size_t>(at.triangle)];
  Eigen::Vector3d weights;
  for (int k = 0; k < 3; ++k)
  {
    const Eigen::Vector3d& b = mesh.vertices[static_cast<std::size_t>(t[(k + 1) % 3])];
    const Eigen::Vector3d& c = mesh.vertices[static_cast<std::size_t>(t[(k + 2) % 3])];
    weights[k] = (b - at.point).cross(c - at.point).norm();
  }
  return weights.sum() > 0.0 ? Eigen::Vector3d(weights / weights.sum()) : Eigen::Vector3d::Constant(1.0 / 3.0);
}

Eigen::Vector3d normalAt(const TriangleMesh& mesh, const std::vector<Eigen::Vector3d>& normals, const ClosestPoint& at)
{
  const Eigen::Vector3i& t = mesh.triangles[static_cast<std::size_t>(at.triangle)];
  const Eigen::Vector3d weights = barycentric(mesh, at);
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k)
    normal += weights[k] * normals[static_cast<std::size_t>(t[k])];
  return normal.norm() > 0.0 ? Eigen::Vector3d(normal.normalized()) : normals[static_cast<std::size_t>(t[0])];
}

double SignedMeshDistance::at(const Eigen::Vector3d& p) const
{
  const ClosestPoint closest = distance_.closest(p);
  return (p - closest.point).dot(normalAt(mesh_, normals_, closest)) < 0.0 ? -closest.distance : closest.distance;
}

}  // namespace endovascular_sim::geometry
