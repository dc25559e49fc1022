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
#include "vessel/repair/cap_removal.h"
#include "vessel/repair/hole_closing.h"
#include "vessel/repair/mesh_check.h"

namespace endovascular_sim::vessel
{
namespace
{

/** Volume of a crumb relative to the vessel; closed components below it are dropped. */
constexpr double kCrumbVolume = 1e-6;

std::string counted(int count, const std::string& singular, const std::string& plural)
{
  return std::to_string(count) + " " + (count == 1 ? singular : plural);
}

/** Welds each vertex to the earliest one within kWeldDistance. */
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

/** Drops closed components of negligible volume relative to the largest one. */
int dropCrumbs(geometry::TriangleMesh& mesh)
{
  struct Piece
  {
    bool closed = true;
    double volume = 0.0;
  };
  const std::vector<geometry::HalfEdge> half_edges = geometry::sortedHalfEdges(mesh);
  const std::vector<int> component = geometry::triangleComponents(mesh, half_edges);
  std::map<int, Piece> pieces;
  for (std::size_t begin = 0; begin < half_edges.size(); begin = geometry::endOfEdge(half_edges, begin))
    if (geometry::endOfEdge(half_edges, begin) - begin != 2)
      pieces[component[static_cast<std::size_t>(half_edges[begin].triangle)]].closed = false;
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

/** Splits non-manifold vertices: every fan of faces receives a vertex of its own. */
int separateTouchingSheets(geometry::TriangleMesh& mesh)
{
  const std::vector<int> fans = geometry::cornerFans(mesh, geometry::sortedHalfEdges(mesh));
  std::map<std::pair<int, int>, int> vertex_of_fan;
  std::vector<bool> taken(mesh.vertices.size(), false);
  int split = 0;
  for (std::size_t c = 0; c < fans.size(); ++c)
  {
    int& corner = mesh.triangles[c / 3][static_cast<int>(c % 3)];
    const auto [entry, is_new] = vertex_of_fan.try_emplace({corner, fans[c]}, corner);
    if (is_new && taken[static_cast<std::size_t>(corner)])
    {
      entry->second = static_cast<int>(mesh.vertices.size());
      mesh.vertices.push_back(Eigen::Vector3d(mesh.vertices[static_cast<std::size_t>(corner)]));
      ++split;
    }
    else if (is_new)
      taken[static_cast<std::size_t>(corner)] = true;
    corner = entry->second;
  }
  return split;
}

void invert(Eigen::Vector3i& triangle)
{
  std::swap(triangle[1], triangle[2]);
}

}  // namespace

int alignFaces(geometry::TriangleMesh& mesh)
{
  const std::vector<geometry::HalfEdge> half_edges = geometry::sortedHalfEdges(mesh);
  struct Neighbour
  {
    int triangle;
    bool agrees;
  };
  std::vector<std::vector<Neighbour>> neighbours(mesh.triangles.size());
  for (std::size_t begin = 0; begin < half_edges.size(); begin = geometry::endOfEdge(half_edges, begin))
  {
    if (geometry::endOfEdge(half_edges, begin) - begin != 2)
      continue;
    const geometry::HalfEdge& a = half_edges[begin];
    const geometry::HalfEdge& b = half_edges[begin + 1];
    neighbours[static_cast<std::size_t>(a.triangle)].push_back({b.triangle, a.forward != b.forward});
    neighbours[static_cast<std::size_t>(b.triangle)].push_back({a.triangle, a.forward != b.forward});
  }
  enum : char
  {
    kUnseen,
    kKeep,
    kInvert
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
        const char required = next.agrees == (state[open.front()] == kKeep) ? kKeep : kInvert;
        char& known = state[static_cast<std::size_t>(next.triangle)];
        if (known != kUnseen && known != required)
          return -1;
        if (known == kUnseen)
        {
          known = required;
          open.push(static_cast<std::size_t>(next.triangle));
        }
      }
  }
  int inverted = 0;
  for (std::size_t t = 0; t < state.size(); ++t)
    if (state[t] == kInvert)
    {
      invert(mesh.triangles[t]);
      ++inverted;
    }
  // The minority was misoriented.
  return std::min(inverted, static_cast<int>(state.size()) - inverted);
}

namespace
{

/** Closes the planar ends of a vessel by lids. No effect if there are other holes.
 *  @return number of lids */
int closeFlatEnds(geometry::TriangleMesh& mesh)
{
  ClosedMesh closed = closeHoles(mesh);
  if (closed.holes.empty() || !std::all_of(closed.holes.begin(), closed.holes.end(), isFlatEnd))
    return 0;
  mesh = std::move(closed.mesh);
  return static_cast<int>(closed.holes.size());
}

/** Rejects meshes with defects that have no safe repair. */
void requireRepairable(const MeshReport& report, const std::string& source)
{
  MeshReport irreparable;
  irreparable.boundary_edges = report.boundary_edges;
  irreparable.non_manifold_edges = report.non_manifold_edges;
  irreparable.components.resize(1);
  irreparable.signed_volume = 1.0;
  std::string reason = irreparable.summary();
  if (report.components.size() > 1)
    reason += (reason.empty() ? "" : "; ") + std::to_string(report.components.size()) +
              " separate components (the two largest have " + std::to_string(report.components[0].triangles) + " and " +
              std::to_string(report.components[1].triangles) + " triangles, the second near " +
              formatLocation(report.components[1].location) + ")";
  if (!reason.empty())
    throw InputError(source, "",
                     "the mesh is not a closed surface of one lumen and cannot be repaired safely: " + reason +
                         ". vessel_prepare closes holes, unites components and remeshes: docs/VESSELS.md");
}

}  // namespace

RepairedMesh repairMesh(geometry::TriangleMesh mesh, const std::string& source, const ProgressReport& progress)
{
  RepairedMesh result;
  const auto note = [&result](int count, const std::string& singular, const std::string& plural)
  {
    if (count > 0)
      result.notes.push_back(counted(count, singular, plural));
  };
  const auto stage = [&progress](double fraction) { reportProgress(progress, "repair of the mesh", fraction); };
  stage(0.0);
  note(weld(mesh), "vertex welded", "vertices welded");
  // Before edges are flipped: collapsed and duplicate faces would make their edges non-manifold.
  int without_area = dropCollapsed(mesh);
  const int duplicates = dropDuplicates(mesh);
  stage(0.3);
  note(removeCaps(mesh, kWeldDistance), "edge of a cap triangle flipped", "edges of cap triangles flipped");
  without_area += dropDegenerate(mesh);
  note(without_area, "degenerate face dropped", "degenerate faces dropped");
  note(duplicates, "duplicate face dropped", "duplicate faces dropped");
  stage(0.5);
  note(dropCrumbs(mesh), "face of a component without volume dropped", "faces of components without volume dropped");
  dropUnused(mesh);
  if (mesh.triangles.empty())
    throw InputError(source, "", "has only degenerate triangles");
  stage(0.6);
  note(closeFlatEnds(mesh), "planar end closed by a lid", "planar ends closed by lids");
  requireRepairable(checkMesh(mesh), source);

  stage(0.8);
  note(separateTouchingSheets(mesh), "vertex shared by two sheets split", "vertices shared by two sheets split");
  const int inverted = alignFaces(mesh);
  if (inverted < 0)
    throw InputError(source, "", "the surface is one-sided (like a Möbius strip): it encloses no lumen");
  note(inverted, "misoriented face inverted", "misoriented faces inverted");
  if (mesh.signedVolume() < 0.0)
  {
    std::for_each(mesh.triangles.begin(), mesh.triangles.end(), invert);
    result.notes.emplace_back("all faces inverted: they pointed into the lumen");
  }
  stage(0.9);
  requireClean(checkMesh(mesh), source);
  result.mesh = std::move(mesh);
  return result;
}

}  // namespace endovascular_sim::vessel
