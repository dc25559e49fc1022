#include "geometry/triangle_mesh.h"

#include <Eigen/Geometry>

#include "common/hash.h"

namespace endovascular_sim::geometry
{

double TriangleMesh::signedVolume() const
{
  if (vertices.empty())
    return 0.0;
  // Computed about a vertex: a mesh far from the origin would lose digits by cancellation.
  const Eigen::Vector3d origin = vertices.front();
  double six_volumes = 0.0;
  for (const Eigen::Vector3i& t : triangles)
  {
    const Eigen::Vector3d a = vertices[static_cast<std::size_t>(t[0])] - origin;
    const Eigen::Vector3d b = vertices[static_cast<std::size_t>(t[1])] - origin;
    const Eigen::Vector3d c = vertices[static_cast<std::size_t>(t[2])] - origin;
    six_volumes += a.dot(b.cross(c));
  }
  return six_volumes / 6.0;
}

std::uint64_t TriangleMesh::hash() const
{
  Hash64 hash;
  hash.add(static_cast<std::uint64_t>(vertices.size()));
  for (const Eigen::Vector3d& v : vertices)
    for (int i = 0; i < 3; ++i)
      hash.add(v[i]);
  hash.add(static_cast<std::uint64_t>(triangles.size()));
  for (const Eigen::Vector3i& t : triangles)
    for (int i = 0; i < 3; ++i)
      hash.add(static_cast<std::uint64_t>(t[i]));
  return hash.value();
}

}  // namespace endovascular_sim::geometry
