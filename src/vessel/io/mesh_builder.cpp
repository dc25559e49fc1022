#include "vessel/io/mesh_builder.h"

#include <cmath>
#include <utility>

#include "common/error.h"
#include "geometry/polygon_triangulation.h"

namespace endovascular_sim::vessel
{

bool namesRasSpace(std::string_view header)
{
  return header.find("SPACE=RAS") != std::string_view::npos;
}

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
  if (is_ras_)
    turnFromRas();
  return std::move(mesh_);
}

void MeshBuilder::turnFromRas()
{
  for (Eigen::Vector3d& v : mesh_.vertices)
    v = Eigen::Vector3d(0.0 - v.x(), 0.0 - v.y(), v.z());
  remarks_.notes.emplace_back(
      "turned from RAS, which the file names (SPACE=RAS), to the patient frame (LPS); a rotation of the scene must not "
      "do it again");
}

void MeshBuilder::triangulate(std::size_t first, std::size_t last)
{
  ring_.clear();
  for (std::size_t k = first; k < last; ++k)
    ring_.push_back(static_cast<int>(corners_[k]));
  if (ring_.size() == 3)
    addTriangle(ring_[0], ring_[1], ring_[2]);
  else
    for (const Eigen::Vector3i& t : geometry::triangulatePolygon(ring_, positions_))
      addTriangle(t[0], t[1], t[2]);
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
