#include "vessel/repair/cap_removal.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/mesh_topology.h"

namespace endovascular_sim::vessel
{
namespace
{

constexpr int kMaxRounds = 200;  // in a row of caps, each round flips the outermost ones
constexpr double kGain = 1.01;   // minimum gain of height by a flip, above rounding

/** Area vector times two: normal of the triangle [m²]. */
Eigen::Vector3d areaVector(const geometry::TriangleMesh& mesh, const Eigen::Vector3i& triangle)
{
  const auto corner = [&](int k) { return mesh.vertices[static_cast<std::size_t>(triangle[k])]; };
  return (corner(1) - corner(0)).cross(corner(2) - corner(0));
}

/** Longest edge of a triangle and the height above it. */
struct Base
{
  int side;       // index of the longest edge, which joins corner side and corner (side + 1) % 3
  double height;  // height above the longest edge [m]
};

Base baseOf(const geometry::TriangleMesh& mesh, const Eigen::Vector3i& triangle)
{
  const auto corner = [&](int k) { return mesh.vertices[static_cast<std::size_t>(triangle[k % 3])]; };
  Base base{0, 0.0};
  double longest = -1.0;
  for (int k = 0; k < 3; ++k)
  {
    const double length = (corner(k + 1) - corner(k)).norm();
    if (length > longest)
      base.side = k, longest = length;
  }
  base.height = longest > 0.0 ? areaVector(mesh, triangle).norm() / longest : 0.0;
  return base;
}

using Diagonal = std::pair<int, int>;

bool isEdge(const std::vector<geometry::HalfEdge>& half_edges, const Diagonal& edge)
{
  const auto half_edge = std::lower_bound(half_edges.begin(), half_edges.end(), edge,
                                          [](const geometry::HalfEdge& h, const Diagonal& sought)
                                          { return std::pair(h.low, h.high) < sought; });
  return half_edge != half_edges.end() && half_edge->low == edge.first && half_edge->high == edge.second;
}

/** Flips the edge between two triangles if both keep their orientation and the smaller height increases.
 *  @return true if the edge was flipped */
bool flipEdge(geometry::TriangleMesh& mesh, const geometry::HalfEdge& of_cap, const geometry::HalfEdge& beside)
{
  Eigen::Vector3i& cap = mesh.triangles[static_cast<std::size_t>(of_cap.triangle)];
  Eigen::Vector3i& other = mesh.triangles[static_cast<std::size_t>(beside.triangle)];
  const int a = cap[of_cap.side];
  const int b = cap[(of_cap.side + 1) % 3];
  const int c = cap[(of_cap.side + 2) % 3];
  const int d = other[(beside.side + 2) % 3];
  const Eigen::Vector3i first(c, a, d), second(d, b, c);
  const auto height = [&mesh](const Eigen::Vector3i& triangle) { return baseOf(mesh, triangle).height; };
  const Eigen::Vector3d before = areaVector(mesh, cap) + areaVector(mesh, other);
  if (areaVector(mesh, first).dot(before) <= 0.0 || areaVector(mesh, second).dot(before) <= 0.0 ||
      std::min(height(first), height(second)) <= kGain * std::min(height(cap), height(other)))
    return false;
  cap = first;
  other = second;
  return true;
}

/** Flips the longest edges of caps, at most one edge per triangle.
 *  @return number of flipped edges */
int removeCapsOnce(geometry::TriangleMesh& mesh, double min_height)
{
  std::vector<int> base_side(mesh.triangles.size(), -1);
  bool any = false;
  for (std::size_t t = 0; t < base_side.size(); ++t)
  {
    const Base base = baseOf(mesh, mesh.triangles[t]);
    if (base.height < min_height)
      base_side[t] = base.side, any = true;
  }
  if (!any)
    return 0;
  const std::vector<geometry::HalfEdge> half_edges = geometry::sortedHalfEdges(mesh);
  std::vector<bool> flipped(mesh.triangles.size(), false);
  std::set<Diagonal> new_diagonals;
  int count = 0;
  for (std::size_t begin = 0; begin < half_edges.size(); begin = geometry::endOfEdge(half_edges, begin))
  {
    if (geometry::endOfEdge(half_edges, begin) - begin != 2)
      continue;
    const geometry::HalfEdge* cap = &half_edges[begin];
    const geometry::HalfEdge* beside = &half_edges[begin + 1];
    const auto at = [](const geometry::HalfEdge* half_edge) { return static_cast<std::size_t>(half_edge->triangle); };
    if (base_side[at(cap)] != cap->side)
      std::swap(cap, beside);
    // The orientation at an edge between two caps is unreliable. The outermost caps of a row are flipped first.
    if (base_side[at(cap)] != cap->side || base_side[at(beside)] >= 0 || cap->forward == beside->forward ||
        flipped[at(cap)] || flipped[at(beside)])
      continue;
    const int c = mesh.triangles[at(cap)][(cap->side + 2) % 3];
    const int d = mesh.triangles[at(beside)][(beside->side + 2) % 3];
    const Diagonal diagonal = std::minmax(c, d);
    if (c == d || isEdge(half_edges, diagonal) || new_diagonals.count(diagonal) > 0 || !flipEdge(mesh, *cap, *beside))
      continue;
    new_diagonals.insert(diagonal);
    flipped[at(cap)] = flipped[at(beside)] = true;
    ++count;
  }
  return count;
}

}  // namespace

int removeCaps(geometry::TriangleMesh& mesh, double min_height)
{
  int count = 0;
  for (int round = 0; round < kMaxRounds; ++round)
  {
    const int flipped = removeCapsOnce(mesh, min_height);
    count += flipped;
    if (flipped == 0)
      break;
  }
  return count;
}

}  // namespace endovascular_sim::vessel
