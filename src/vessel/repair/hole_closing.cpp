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

/** A rim is flat when it leaves its plane by less than this fraction of its perimeter. */
constexpr double kFlat = 1e-3;
/** Fewer edges are a hole in a wall rather than the round end of a vessel. */
constexpr int kFewestEdges = 8;

struct RimEdge
{
  int from;  ///< as the face at the rim runs
  int to;
};

/** Rims by their smallest vertex, each with its edges in the order of the mesh's edges. */
std::map<int, std::vector<RimEdge>> findRims(const geometry::TriangleMesh& mesh)
{
  const std::vector<geometry::EdgeUse> uses = geometry::sortedEdgeUses(mesh);
  std::vector<geometry::EdgeUse> rim_edges;
  geometry::DisjointSets sets(mesh.vertices.size());
  for (std::size_t begin = 0; begin < uses.size(); begin = geometry::endOfEdge(uses, begin))
    if (geometry::endOfEdge(uses, begin) - begin == 1)
    {
      rim_edges.push_back(uses[begin]);
      sets.join(uses[begin].low, uses[begin].high);
    }
  std::map<int, std::vector<RimEdge>> rims;
  for (const geometry::EdgeUse& use : rim_edges)
    rims[sets.find(use.low)].push_back(use.forward ? RimEdge{use.low, use.high} : RimEdge{use.high, use.low});
  return rims;
}

/** Every vertex is left once and reached once: one loop, as its edges are connected. */
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

/** Appends the fan over a rim to the mesh. */
ClosedHole addLid(geometry::TriangleMesh& mesh, const std::vector<RimEdge>& rim)
{
  const auto at = [&mesh](int v) -> const Eigen::Vector3d& { return mesh.vertices[static_cast<std::size_t>(v)]; };
  ClosedHole hole;
  hole.edges = static_cast<int>(rim.size());
  for (const RimEdge& edge : rim)
  {
    const double length = (at(edge.to) - at(edge.from)).norm();
    hole.perimeter += length;
    hole.place += 0.5 * length * (at(edge.from) + at(edge.to));
  }
  hole.place = hole.perimeter > 0.0 ? Eigen::Vector3d(hole.place / hole.perimeter) : at(rim.front().from);

  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  for (const RimEdge& edge : rim)
    area += 0.5 * (at(edge.to) - hole.place).cross(at(edge.from) - hole.place);
  const Eigen::Vector3d normal = area.norm() > 0.0 ? Eigen::Vector3d(area.normalized()) : Eigen::Vector3d::UnitZ();
  hole.simple = isLoop(rim);
  const int centre = static_cast<int>(mesh.vertices.size());
  mesh.vertices.push_back(hole.place);
  for (const RimEdge& edge : rim)
  {
    const Eigen::Vector3d face = 0.5 * (at(edge.to) - hole.place).cross(at(edge.from) - hole.place);
    hole.area += face.norm();
    hole.simple = hole.simple && face.dot(normal) > 0.0;
    hole.unevenness = std::max(hole.unevenness, std::abs((at(edge.from) - hole.place).dot(normal)));
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
  return hole.simple && hole.edges >= kFewestEdges && hole.unevenness <= kFlat * hole.perimeter;
}

}  // namespace endovascular_sim::vessel
