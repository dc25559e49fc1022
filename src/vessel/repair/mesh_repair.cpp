#include "vessel/repair/mesh_repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <queue>
#include <set>

#include <Eigen/Geometry>

#include "common/error.h"
#include "geometry/mesh_topology.h"
#include "vessel/repair/cap_flipping.h"
#include "vessel/repair/hole_closing.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::vessel
{
namespace
{

/** A closed crumb that encloses less than this fraction of the vessel's volume is dropped. */
constexpr double kCrumbVolume = 1e-6;

std::string counted(int count, const std::string& singular, const std::string& plural)
{
  return std::to_string(count) + " " + (count == 1 ? singular : plural);
}

/** Joins each vertex to the earliest one within kWeldDistance. */
int weld(geometry::TriangleMesh& mesh)
{
  using Cell = std::array<std::int64_t, 3>;
  const auto cellOf = [](const Eigen::Vector3d& v)
  {
    Cell cell;
    for (int i = 0; i < 3; ++i)
      cell[static_cast<std::size_t>(i)] = static_cast<std::int64_t>(std::floor(v[i] / kWeldDistance));
    return cell;
  };
  std::map<Cell, int> first_in_cell;
  std::vector<int> target(mesh.vertices.size());
  int joined = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
  {
    const Cell cell = cellOf(mesh.vertices[v]);
    int match = static_cast<int>(v);
    for (std::int64_t k = 0; k < 27; ++k)
    {
      const auto near = first_in_cell.find({cell[0] + k % 3 - 1, cell[1] + k / 3 % 3 - 1, cell[2] + k / 9 - 1});
      if (near != first_in_cell.end() && near->second < match &&
          (mesh.vertices[static_cast<std::size_t>(near->second)] - mesh.vertices[v]).norm() <= kWeldDistance)
        match = near->second;
    }
    target[v] = match;
    if (match == static_cast<int>(v))
      first_in_cell.try_emplace(cell, match);
    else
      ++joined;
  }
  for (Eigen::Vector3i& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      t[k] = target[static_cast<std::size_t>(t[k])];
  return joined;
}

template <typename Predicate>
int dropTriangles(geometry::TriangleMesh& mesh, Predicate drop)
{
  const std::size_t before = mesh.triangles.size();
  mesh.triangles.erase(std::remove_if(mesh.triangles.begin(), mesh.triangles.end(), drop), mesh.triangles.end());
  return static_cast<int>(before - mesh.triangles.size());
}

int dropCollapsed(geometry::TriangleMesh& mesh)
{
  return dropTriangles(mesh, [](const Eigen::Vector3i& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
}

int dropDegenerate(geometry::TriangleMesh& mesh)
{
  return dropTriangles(mesh,
                       [&mesh](const Eigen::Vector3i& t)
                       {
                         const auto at = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
                         return (at(1) - at(0)).cross(at(2) - at(0)).squaredNorm() == 0.0;
                       });
}

int dropDuplicates(geometry::TriangleMesh& mesh)
{
  std::set<std::array<int, 3>> seen;
  return dropTriangles(mesh,
                       [&seen](const Eigen::Vector3i& t)
                       {
                         std::array<int, 3> key{t[0], t[1], t[2]};
                         std::sort(key.begin(), key.end());
                         return !seen.insert(key).second;
                       });
}

int dropUnused(geometry::TriangleMesh& mesh)
{
  std::vector<int> index(mesh.vertices.size(), -1);
  for (const Eigen::Vector3i& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      index[static_cast<std::size_t>(t[k])] = 0;
  int kept = 0;
  for (std::size_t v = 0; v < index.size(); ++v)
    if (index[v] == 0)
    {
      mesh.vertices[static_cast<std::size_t>(kept)] = mesh.vertices[v];
      index[v] = kept++;
    }
  const int dropped = static_cast<int>(mesh.vertices.size()) - kept;
  mesh.vertices.resize(static_cast<std::size_t>(kept));
  for (Eigen::Vector3i& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      t[k] = index[static_cast<std::size_t>(t[k])];
  return dropped;
}

/** Closed components that enclose next to nothing beside the largest one. */
int dropCrumbs(geometry::TriangleMesh& mesh)
{
  struct Piece
  {
    bool closed = true;
    double volume = 0.0;
  };
  const std::vector<geometry::EdgeUse> uses = geometry::sortedEdgeUses(mesh);
  const std::vector<int> component = geometry::triangleComponents(mesh, uses);
  std::map<int, Piece> pieces;
  for (std::size_t begin = 0; begin < uses.size(); begin = geometry::endOfEdge(uses, begin))
    if (geometry::endOfEdge(uses, begin) - begin != 2)
      pieces[component[static_cast<std::size_t>(uses[begin].triangle)]].closed = false;
  for (std::size_t t = 0; t < component.size(); ++t)
  {
    const auto at = [&](int k)
    { return Eigen::Vector3d(mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])] - mesh.vertices.front()); };
    pieces[component[t]].volume += at(0).dot(at(1).cross(at(2))) / 6.0;
  }
  double largest = 0.0;
  for (const auto& [representative, piece] : pieces)
    largest = std::max(largest, piece.closed ? std::abs(piece.volume) : 0.0);
  std::size_t t = 0;
  return dropTriangles(mesh,
                       [&](const Eigen::Vector3i&)
                       {
                         const Piece& piece = pieces[component[t++]];
                         return piece.closed && std::abs(piece.volume) < kCrumbVolume * largest;
                       });
}

/** Gives every further fan of faces around a vertex a vertex of its own. */
int partTouchingSheets(geometry::TriangleMesh& mesh)
{
  const std::vector<geometry::EdgeUse> uses = geometry::sortedEdgeUses(mesh);
  geometry::DisjointSets corners(3 * mesh.triangles.size());
  for (std::size_t begin = 0; begin < uses.size(); begin = geometry::endOfEdge(uses, begin))
    for (std::size_t k = begin + 1; k < geometry::endOfEdge(uses, begin); ++k)
      for (int vertex : {uses[begin].low, uses[begin].high})
      {
        const auto cornerAt = [&](const geometry::EdgeUse& use)
        {
          const bool first = mesh.triangles[static_cast<std::size_t>(use.triangle)][use.side] == vertex;
          return 3 * use.triangle + (first ? use.side : (use.side + 1) % 3);
        };
        corners.join(cornerAt(uses[begin]), cornerAt(uses[k]));
      }
  std::map<std::pair<int, int>, int> vertex_of_fan;
  std::vector<bool> taken(mesh.vertices.size(), false);
  int parted = 0;
  for (std::size_t c = 0; c < 3 * mesh.triangles.size(); ++c)
  {
    int& corner = mesh.triangles[c / 3][static_cast<int>(c % 3)];
    const auto [entry, is_new] = vertex_of_fan.try_emplace({corner, corners.find(static_cast<int>(c))}, corner);
    if (is_new && taken[static_cast<std::size_t>(corner)])
    {
      entry->second = static_cast<int>(mesh.vertices.size());
      mesh.vertices.push_back(Eigen::Vector3d(mesh.vertices[static_cast<std::size_t>(corner)]));
      ++parted;
    }
    else if (is_new)
      taken[static_cast<std::size_t>(corner)] = true;
    corner = entry->second;
  }
  return parted;
}

void turn(Eigen::Vector3i& triangle)
{
  std::swap(triangle[1], triangle[2]);
}

}  // namespace

int alignFaces(geometry::TriangleMesh& mesh)
{
  const std::vector<geometry::EdgeUse> uses = geometry::sortedEdgeUses(mesh);
  struct Neighbour
  {
    int triangle;
    bool agrees;
  };
  std::vector<std::vector<Neighbour>> neighbours(mesh.triangles.size());
  for (std::size_t begin = 0; begin < uses.size(); begin = geometry::endOfEdge(uses, begin))
  {
    if (geometry::endOfEdge(uses, begin) - begin != 2)
      continue;
    const geometry::EdgeUse& a = uses[begin];
    const geometry::EdgeUse& b = uses[begin + 1];
    neighbours[static_cast<std::size_t>(a.triangle)].push_back({b.triangle, a.forward != b.forward});
    neighbours[static_cast<std::size_t>(b.triangle)].push_back({a.triangle, a.forward != b.forward});
  }
  enum : char
  {
    kUnseen,
    kKeep,
    kTurn
  };
  std::vector<char> state(mesh.triangles.size(), kUnseen);
  for (std::size_t seed = 0; seed < state.size(); ++seed)
  {
    if (state[seed] != kUnseen)
      continue;
    state[seed] = kKeep;
    std::queue<std::size_t> open;
    for (open.push(seed); !open.empty(); open.pop())
      for (const Neighbour& next : neighbours[open.front()])
      {
        const char wanted = next.agrees == (state[open.front()] == kKeep) ? kKeep : kTurn;
        char& known = state[static_cast<std::size_t>(next.triangle)];
        if (known != kUnseen && known != wanted)
          return -1;
        if (known == kUnseen)
        {
          known = wanted;
          open.push(static_cast<std::size_t>(next.triangle));
        }
      }
  }
  int turned = 0;
  for (std::size_t t = 0; t < state.size(); ++t)
    if (state[t] == kTurn)
    {
      turn(mesh.triangles[t]);
      ++turned;
    }
  // The minority is what was wrong.
  return std::min(turned, static_cast<int>(state.size()) - turned);
}

namespace
{

/** Puts lids on the open ends of a vessel cut across; does nothing when there are other holes.
 *  @return the number of lids */
int closeFlatEnds(geometry::TriangleMesh& mesh)
{
  ClosedMesh closed = closeHoles(mesh);
  if (closed.holes.empty() || !std::all_of(closed.holes.begin(), closed.holes.end(), isFlatEnd))
    return 0;
  mesh = std::move(closed.mesh);
  return static_cast<int>(closed.holes.size());
}

/** Refuses what no safe repair can mend. */
void requireRepairable(const MeshReport& report, const std::string& source)
{
  MeshReport hopeless;
  hopeless.boundary_edges = report.boundary_edges;
  hopeless.non_manifold_edges = report.non_manifold_edges;
  hopeless.components.resize(1);
  hopeless.signed_volume = 1.0;
  std::string reason = hopeless.summary();
  if (report.components.size() > 1)
    reason += (reason.empty() ? "" : "; ") + std::to_string(report.components.size()) +
              " separate components (the two largest have " + std::to_string(report.components[0].triangles) + " and " +
              std::to_string(report.components[1].triangles) + " triangles, the second near " +
              formatPlace(report.components[1].place) + ")";
  if (!reason.empty())
    throw InputError(source, "",
                     "the mesh is not a closed surface of one lumen and cannot be repaired safely: " + reason +
                         ". vessel_prepare closes holes, unites parts and re-meshes: docs/VESSELS.md");
}

}  // namespace

RepairedMesh repairMesh(geometry::TriangleMesh mesh, const std::string& source)
{
  RepairedMesh result;
  const auto note = [&result](int count, const std::string& singular, const std::string& plural)
  {
    if (count > 0)
      result.notes.push_back(counted(count, singular, plural));
  };
  note(weld(mesh), "vertex joined to an equal one", "vertices joined to equal ones");
  // Before edges are turned, because they would be those of more than two faces.
  int without_area = dropCollapsed(mesh);
  const int duplicates = dropDuplicates(mesh);
  note(flipCaps(mesh, kWeldDistance), "edge turned beside a face without height",
       "edges turned beside faces without height");
  without_area += dropDegenerate(mesh);
  note(without_area, "face without area dropped", "faces without area dropped");
  note(duplicates, "duplicate face dropped", "duplicate faces dropped");
  note(dropCrumbs(mesh), "stray face that encloses nothing dropped", "stray faces that enclose nothing dropped");
  dropUnused(mesh);
  if (mesh.triangles.empty())
    throw InputError(source, "", "has no triangle with an area");
  note(closeFlatEnds(mesh), "open end closed by a flat lid", "open ends closed by flat lids");
  requireRepairable(checkMesh(mesh), source);

  note(partTouchingSheets(mesh), "vertex parted where two sheets touched", "vertices parted where two sheets touched");
  const int turned = alignFaces(mesh);
  if (turned < 0)
    throw InputError(source, "", "the surface is one-sided (like a Möbius strip): it encloses no lumen");
  note(turned, "face turned to agree with its neighbours", "faces turned to agree with their neighbours");
  if (mesh.signedVolume() < 0.0)
  {
    std::for_each(mesh.triangles.begin(), mesh.triangles.end(), turn);
    result.notes.emplace_back("all faces turned: they pointed into the lumen");
  }
  requireClean(checkMesh(mesh), source);
  result.mesh = std::move(mesh);
  return result;
}

}  // namespace endovascular_sim::vessel
