#include "vessel/repair/mesh_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <Eigen/Geometry>

#include "common/error.h"
#include "common/text/format.h"
#include "geometry/mesh_topology.h"

namespace endovascular_sim::vessel
{
namespace
{

const Eigen::Vector3d& corner(const geometry::TriangleMesh& mesh, int t, int k)
{
  return mesh.vertices[static_cast<std::size_t>(mesh.triangles[static_cast<std::size_t>(t)][k])];
}

void checkIndices(const geometry::TriangleMesh& mesh, MeshReport& report)
{
  const int count = static_cast<int>(mesh.vertices.size());
  for (const Eigen::Vector3d& v : mesh.vertices)
    if (!v.allFinite())
      report.invalid_faces.add(Eigen::Vector3d::Zero());
  for (const Eigen::Vector3i& t : mesh.triangles)
    if (t.minCoeff() < 0 || t.maxCoeff() >= count)
      report.invalid_faces.add(Eigen::Vector3d::Zero());
}

void checkFaces(const geometry::TriangleMesh& mesh, MeshReport& report)
{
  std::vector<std::pair<std::array<int, 3>, int>> corners;
  std::vector<bool> used(mesh.vertices.size(), false);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
  {
    const int index = static_cast<int>(t);
    std::array<int, 3> key{mesh.triangles[t][0], mesh.triangles[t][1], mesh.triangles[t][2]};
    for (int v : key)
      used[static_cast<std::size_t>(v)] = true;
    std::sort(key.begin(), key.end());
    corners.emplace_back(key, index);
    const Eigen::Vector3d& a = corner(mesh, index, 0);
    if ((corner(mesh, index, 1) - a).cross(corner(mesh, index, 2) - a).squaredNorm() == 0.0)
      report.degenerate_faces.add(a);
  }
  std::sort(corners.begin(), corners.end());
  for (std::size_t k = 1; k < corners.size(); ++k)
    if (corners[k].first == corners[k - 1].first)
      report.duplicate_faces.add(corner(mesh, corners[k].second, 0));
  for (std::size_t v = 0; v < used.size(); ++v)
    if (!used[v])
      report.unused_vertices.add(mesh.vertices[v]);
}

void checkEdges(const geometry::TriangleMesh& mesh, const std::vector<geometry::HalfEdge>& half_edges,
                MeshReport& report)
{
  for (std::size_t begin = 0; begin < half_edges.size();)
  {
    const std::size_t end = geometry::endOfEdge(half_edges, begin);
    const Eigen::Vector3d location = 0.5 * (mesh.vertices[static_cast<std::size_t>(half_edges[begin].low)] +
                                            mesh.vertices[static_cast<std::size_t>(half_edges[begin].high)]);
    if (end - begin == 1)
      report.boundary_edges.add(location);
    else if (end - begin > 2)
      report.non_manifold_edges.add(location);
    else if (half_edges[begin].forward == half_edges[begin + 1].forward)
      report.misoriented_edges.add(location);
    begin = end;
  }
}

void checkComponents(const geometry::TriangleMesh& mesh, const std::vector<geometry::HalfEdge>& half_edges,
                     MeshReport& report)
{
  const std::vector<int> component = geometry::triangleComponents(mesh, half_edges);
  std::map<int, MeshComponent> by_representative;
  const Eigen::Vector3d origin = mesh.vertices.front();
  for (std::size_t t = 0; t < component.size(); ++t)
  {
    const int index = static_cast<int>(t);
    MeshComponent& piece = by_representative[component[t]];
    if (piece.triangles++ == 0)
      piece.location = corner(mesh, index, 0);
    piece.volume += (corner(mesh, index, 0) - origin)
                        .dot((corner(mesh, index, 1) - origin).cross(corner(mesh, index, 2) - origin)) /
                    6.0;
  }
  for (const auto& [representative, piece] : by_representative)
    report.components.push_back(piece);
  std::stable_sort(report.components.begin(), report.components.end(),
                   [](const MeshComponent& a, const MeshComponent& b) { return a.triangles > b.triangles; });
}

void append(std::string& text, const MeshDefect& defect, const std::string& what)
{
  if (defect.count == 0)
    return;
  text += (text.empty() ? "" : "; ") + std::to_string(defect.count) + " " + what + ", the first near " +
          formatLocation(defect.location);
}

}  // namespace

std::string formatLocation(const Eigen::Vector3d& location)
{
  return formatted("(%.5g, %.5g, %.5g) mm", 1e3 * location.x(), 1e3 * location.y(), 1e3 * location.z());
}

bool MeshReport::clean() const
{
  return summary().empty();
}

std::string MeshReport::summary() const
{
  std::string text;
  append(text, invalid_faces, "faces or vertices with an invalid index or coordinate");
  append(text, boundary_edges, "boundary edges (holes)");
  append(text, non_manifold_edges, "non-manifold edges (three or more faces meet)");
  append(text, non_manifold_vertices, "vertices where separate sheets touch");
  append(text, misoriented_edges, "edges with inconsistently oriented faces");
  append(text, degenerate_faces, "faces without area");
  append(text, duplicate_faces, "duplicate faces");
  append(text, unused_vertices, "unused vertices");
  if (components.size() != 1)
    text += (text.empty() ? "" : "; ") + std::to_string(components.size()) + " separate components";
  if (text.empty() && signed_volume <= 0.0)
    text = "faces point inward";
  return text;
}

MeshReport checkMesh(const geometry::TriangleMesh& mesh)
{
  MeshReport report;
  checkIndices(mesh, report);
  if (report.invalid_faces.count > 0 || mesh.triangles.empty())
    return report;

  report.lower = report.upper = mesh.vertices.front();
  for (const Eigen::Vector3d& v : mesh.vertices)
  {
    report.lower = report.lower.cwiseMin(v);
    report.upper = report.upper.cwiseMax(v);
  }
  const std::vector<geometry::HalfEdge> half_edges = geometry::sortedHalfEdges(mesh);
  checkFaces(mesh, report);
  checkEdges(mesh, half_edges, report);
  for (const int v : geometry::nonManifoldVertices(mesh, half_edges))
    report.non_manifold_vertices.add(mesh.vertices[static_cast<std::size_t>(v)]);
  checkComponents(mesh, half_edges, report);
  report.signed_volume = mesh.signedVolume();

  int edges = 0;
  for (std::size_t begin = 0; begin < half_edges.size(); begin = geometry::endOfEdge(half_edges, begin))
    ++edges;
  const int vertices = static_cast<int>(mesh.vertices.size()) - report.unused_vertices.count;
  const int euler = vertices - edges + static_cast<int>(mesh.triangles.size());
  report.genus = (2 * static_cast<int>(report.components.size()) - euler) / 2;
  return report;
}

void requireClean(const MeshReport& report, const std::string& source)
{
  const std::string summary = report.summary();
  if (!summary.empty())
    throw InputError(source, "",
                     "the mesh is not a closed surface of one lumen: " + summary +
                         "; repair the file, or prepare it with vessel_prepare");
}

}  // namespace endovascular_sim::vessel
