#include "vessel/repair/hole_closing.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Geometry>

#include "geometry/mesh_topology.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Largest unevenness of a planar rim, relative to its perimeter. */
constexpr double kFlat = 1e-3;
/** Minimum number of edges of a vessel's end; holes with fewer edges are defects. */
constexpr int kMinEdges = 8;

/** Boundary edge in the direction of its face. */
struct RimEdge
{
  int from;
  int to;
};

/** Connected boundaries, keyed by their smallest vertex, with sorted edges. */
std::map<int, std::vector<RimEdge>> findRims(const geometry::TriangleMesh& mesh)
{
  const std::vector<geometry::HalfEdge> half_edges = geometry::sortedHalfEdges(mesh);
  std::vector<geometry::HalfEdge> rim_edges;
  geometry::DisjointSets sets(mesh.vertices.size());
  for (std::size_t begin = 0; begin < half_edges.size(); begin = geometry::endOfEdge(half_edges, begin))
    if (geometry::endOfEdge(half_edges, begin) - begin == 1)
    {
      rim_edges.push_back(half_edges[begin]);
      sets.join(half_edges[begin].low, half_edges[begin].high);
    }
  std::map<int, std::vector<RimEdge>> rims;
  for (const geometry::HalfEdge& half_edge : rim_edges)
    rims[sets.find(half_edge.low)].push_back(half_edge.forward ? RimEdge{half_edge.low, half_edge.high}
                                                               : RimEdge{half_edge.high, half_edge.low});
  return rims;
}

/** True if every vertex of a connected rim has one incoming and one outgoing edge. */
bool isLoop(const std::vector<RimEdge>& rim)
{
  std::map<int, std::pair<int, int>> degree;
  for (const RimEdge& edge : rim)
  {
    ++degree[edge.from].first;
    ++degree[edge.to].second;
  }
  return std::all_of(degree.begin(), degree.end(),
                     [](const auto& entry) { return entry.second == std::pair<int, int>(1, 1); });
}

/** Closes a rim by a triangle fan. */
ClosedHole addLid(geometry::TriangleMesh& mesh, const std::vector<RimEdge>& rim)
{
  const auto at = [&mesh](int v) -> const Eigen::Vector3d& { return mesh.vertices[static_cast<std::size_t>(v)]; };
  ClosedHole hole;
  hole.edges = static_cast<int>(rim.size());
  for (const RimEdge& edge : rim)
  {
    const double length = (at(edge.to) - at(edge.from)).norm();
    hole.perimeter += length;
    hole.location += 0.5 * length * (at(edge.from) + at(edge.to));
  }
  hole.location = hole.perimeter > 0.0 ? Eigen::Vector3d(hole.location / hole.perimeter) : at(rim.front().from);

  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  for (const RimEdge& edge : rim)
    area += 0.5 * (at(edge.to) - hole.location).cross(at(edge.from) - hole.location);
  const Eigen::Vector3d normal = area.norm() > 0.0 ? Eigen::Vector3d(area.normalized()) : Eigen::Vector3d::UnitZ();
  hole.simple = isLoop(rim);
  const int centre = static_cast<int>(mesh.vertices.size());
  mesh.vertices.push_back(hole.location);
  for (const RimEdge& edge : rim)
  {
    const Eigen::Vector3d face = 0.5 * (at(edge.to) - hole.location).cross(at(edge.from) - hole.location);
    hole.area += face.norm();
    hole.simple = hole.simple && face.dot(normal) > 0.0;
    hole.unevenness = std::max(hole.unevenness, std::abs((at(edge.from) - hole.location).dot(normal)));
    mesh.triangles.emplace_back(centre, edge.to, edge.from);
  }
  return hole;
}

}  // namespace

ClosedMesh closeHoles(geometry::TriangleMesh mesh)
{
  ClosedMesh closed;
  closed.first_lid = mesh.triangles.size();
  const auto rims = findRims(mesh);
  for (const auto& [vertex, rim] : rims)
    closed.holes.push_back(addLid(mesh, rim));
  closed.mesh = std::move(mesh);
  return closed;
}

bool isFlatEnd(const ClosedHole& hole)
{
  return hole.simple && hole.edges >= kMinEdges && hole.unevenness <= kFlat * hole.perimeter;
}

}  // namespace endovascular_sim::vessel
