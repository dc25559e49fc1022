#include "vessel/io/mesh_builder.h"

#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "common/error.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Twice the signed area of a triangle projected along a direction. */
double projectedArea(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                     const Eigen::Vector3d& direction)
{
  return (b - a).cross(c - a).dot(direction);
}

/** Newell's normal of a polygon: the sum of the vector areas about its first corner. */
Eigen::Vector3d newellNormal(const std::vector<int>& ring, const std::vector<Eigen::Vector3d>& positions)
{
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t k = 1; k + 1 < ring.size(); ++k)
    normal += (positions[ring[k]] - positions[ring[0]]).cross(positions[ring[k + 1]] - positions[ring[0]]);
  return normal;
}

/** True when corner k of a polygon is convex and no other corner lies in its triangle. */
bool isEar(const std::vector<int>& ring, std::size_t k, const std::vector<Eigen::Vector3d>& positions,
           const Eigen::Vector3d& normal)
{
  const std::size_t n = ring.size();
  const int before = ring[(k + n - 1) % n];
  const int after = ring[(k + 1) % n];
  const Eigen::Vector3d& a = positions[before];
  const Eigen::Vector3d& b = positions[ring[k]];
  const Eigen::Vector3d& c = positions[after];
  if (projectedArea(a, b, c, normal) <= 0.0)
    return false;
  for (const int other : ring)
  {
    if (other == before || other == ring[k] || other == after)
      continue;
    const Eigen::Vector3d& p = positions[other];
    if (projectedArea(a, b, p, normal) >= 0.0 && projectedArea(b, c, p, normal) >= 0.0 &&
        projectedArea(c, a, p, normal) >= 0.0)
      return false;
  }
  return true;
}

}  // namespace

void MeshBuilder::refuse(const char* kind, std::size_t index, std::size_t line, const std::string& reason) const
{
  const std::string at = line > 0 ? " (line " + std::to_string(line) + ")" : "";
  throw InputError(path_, std::string(kind) + " " + std::to_string(index) + at, reason);
}

void MeshBuilder::addVertex(const Eigen::Vector3d& position, std::size_t line)
{
  if (!position.allFinite() || !(unit_ * position).allFinite())
    refuse("vertex", positions_.size(), line, "has a coordinate that is not a finite number; export the mesh again");
  positions_.push_back(position);
}

void MeshBuilder::addFace(const std::vector<long long>& corners, std::size_t line)
{
  if (corners.size() > kMaxCorners)
    refuse("face", faces_.size(), line,
           "has " + std::to_string(corners.size()) + " corners; at most " + std::to_string(kMaxCorners) +
               " are read: export the mesh as triangles");
  if (corners.size() < 3)
    return;
  const std::size_t begin = corners_.size();
  corners_.insert(corners_.end(), corners.begin(), corners.end());
  faces_.push_back({begin, corners_.size(), line});
}

geometry::TriangleMesh MeshBuilder::build()
{
  const auto count = static_cast<long long>(positions_.size());
  mesh_vertex_.assign(positions_.size(), -1);
  for (std::size_t f = 0; f < faces_.size(); ++f)
  {
    if (f % kRecordsPerReport == 0)
      reportProgress(progress_, "joining the vertices of the mesh",
                     static_cast<double>(f) / static_cast<double>(faces_.size()));
    const Face& face = faces_[f];
    for (std::size_t k = face.begin; k < face.end; ++k)
      if (corners_[k] < 0 || corners_[k] >= count)
        refuse("face", f, face.line,
               "names vertex " + std::to_string(corners_[k]) + ", but the file has " + std::to_string(count) +
                   " (from 0); the file is damaged");
    triangulate(face.begin, face.end);
  }
  if (mesh_.triangles.empty())
    throw InputError(path_, "", "has no triangles; export the vessel's surface, not points or lines");
  return std::move(mesh_);
}

void MeshBuilder::triangulate(std::size_t first, std::size_t last)
{
  ring_.clear();
  for (std::size_t k = first; k < last; ++k)
    ring_.push_back(static_cast<int>(corners_[k]));
  const Eigen::Vector3d normal = newellNormal(ring_, positions_);
  std::size_t k = 0;
  std::size_t rejected = 0;
  while (ring_.size() > 3)
  {
    const std::size_t n = ring_.size();
    k %= n;
    // A polygon without an ear is degenerate or intersects itself: its corners are cut off in their order.
    if (rejected < n && !isEar(ring_, k, positions_, normal))
    {
      ++k;
      ++rejected;
      continue;
    }
    addTriangle(ring_[(k + n - 1) % n], ring_[k], ring_[(k + 1) % n]);
    ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(k));
    rejected = 0;
  }
  addTriangle(ring_[0], ring_[1], ring_[2]);
}

void MeshBuilder::addTriangle(int a, int b, int c)
{
  const int first = meshVertex(a);
  const int second = meshVertex(b);
  const int third = meshVertex(c);
  mesh_.triangles.emplace_back(first, second, third);
}

int MeshBuilder::meshVertex(int vertex)
{
  int& number = mesh_vertex_[vertex];
  if (number < 0)
  {
    // Adding zero turns −0 into +0: they compare equal, but their bytes differ in the mesh's hash.
    const Eigen::Vector3d& p = positions_[vertex];
    const std::array<double, 3> key{p.x() + 0.0, p.y() + 0.0, p.z() + 0.0};
    const auto [entry, is_new] = by_position_.try_emplace(key, static_cast<int>(mesh_.vertices.size()));
    if (is_new)
      mesh_.vertices.emplace_back(unit_ * key[0], unit_ * key[1], unit_ * key[2]);
    number = entry->second;
  }
  return number;
}

}  // namespace endovascular_sim::vessel
