#include "vessel/repair/hole_closing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/Geometry>

#include "geometry/mesh_topology.h"
#include "geometry/polygon_triangulation.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Largest unevenness of a planar rim, relative to its perimeter. */
constexpr double kFlat = 1e-3;
/** Minimum number of edges of a vessel's end; holes with fewer edges are defects. */
constexpr int kMinEdges = 8;
/** Maximum number of edges of a rim that is closed between its vertices, which takes time cubic in it. */
constexpr std::size_t kMaxEars = 2048;

bool isFlat(const ClosedHole& hole)
{
  return hole.unevenness <= kFlat * hole.perimeter;
}

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

/** Length-weighted centre and perimeter of a rim. */
void measureRim(const geometry::TriangleMesh& mesh, const std::vector<RimEdge>& rim, ClosedHole& hole)
{
  const auto at = [&mesh](int v) -> const Eigen::Vector3d& { return mesh.vertices[static_cast<std::size_t>(v)]; };
  hole.edges = static_cast<int>(rim.size());
  for (const RimEdge& edge : rim)
  {
    const double length = (at(edge.to) - at(edge.from)).norm();
    hole.perimeter += length;
    hole.location += 0.5 * length * (at(edge.from) + at(edge.to));
  }
  hole.location = hole.perimeter > 0.0 ? Eigen::Vector3d(hole.location / hole.perimeter) : at(rim.front().from);
}

/** Vertices of a loop in the direction of its lid, which is against that of the faces. */
std::vector<int> lidRing(const std::vector<RimEdge>& rim)
{
  std::map<int, int> next;
  for (const RimEdge& edge : rim)
    next[edge.to] = edge.from;
  std::vector<int> ring{rim.front().to};
  for (int v = next[ring.front()]; v != ring.front(); v = next[v])
    ring.push_back(v);
  return ring;
}

/** Lid of a hole: triangles, with the sum and the largest fold of their areas. */
struct Lid
{
  std::vector<Eigen::Vector3i> triangles;
  double area = 0.0;       ///< [m²]
  bool has_folds = false;  ///< true if a triangle is turned over or without area
};

Lid lidOf(std::vector<Eigen::Vector3i> triangles, const Eigen::Vector3d& normal,
          const std::vector<Eigen::Vector3d>& vertices)
{
  Lid lid;
  for (const Eigen::Vector3i& t : triangles)
  {
    const auto at = [&](int k) -> const Eigen::Vector3d& { return vertices[static_cast<std::size_t>(t[k])]; };
    const Eigen::Vector3d face = 0.5 * (at(1) - at(0)).cross(at(2) - at(0));
    lid.area += face.norm();
    lid.has_folds = lid.has_folds || face.dot(normal) <= 0.0;
  }
  lid.triangles = std::move(triangles);
  return lid;
}

/** Closes a rim by a triangle fan. A planar loop that no fan about its centre fills, such as a C or a D, is closed by
 *  triangles between its vertices. */
ClosedHole addLid(geometry::TriangleMesh& mesh, const std::vector<RimEdge>& rim)
{
  ClosedHole hole;
  measureRim(mesh, rim, hole);
  const int centre = static_cast<int>(mesh.vertices.size());
  mesh.vertices.push_back(hole.location);
  const auto at = [&mesh](int v) -> const Eigen::Vector3d& { return mesh.vertices[static_cast<std::size_t>(v)]; };
  std::vector<Eigen::Vector3i> fan;
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  for (const RimEdge& edge : rim)
  {
    area += 0.5 * (at(edge.to) - hole.location).cross(at(edge.from) - hole.location);
    fan.emplace_back(centre, edge.to, edge.from);
  }
  const Eigen::Vector3d normal = area.norm() > 0.0 ? Eigen::Vector3d(area.normalized()) : Eigen::Vector3d::UnitZ();
  for (const RimEdge& edge : rim)
    hole.unevenness = std::max(hole.unevenness, std::abs((at(edge.from) - hole.location).dot(normal)));
  Lid lid = lidOf(std::move(fan), normal, mesh.vertices);
  const bool is_loop = isLoop(rim);
  if (lid.has_folds && is_loop && isFlat(hole) && rim.size() <= kMaxEars)
    if (Lid ears = lidOf(geometry::triangulatePolygon(lidRing(rim), mesh.vertices), normal, mesh.vertices);
        !ears.has_folds)
    {
      lid = std::move(ears);
      mesh.vertices.pop_back();
    }
  hole.simple = is_loop && !lid.has_folds;
  hole.area = lid.area;
  mesh.triangles.insert(mesh.triangles.end(), lid.triangles.begin(), lid.triangles.end());
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
  return hole.simple && hole.edges >= kMinEdges && isFlat(hole);
}

}  // namespace endovascular_sim::vessel
