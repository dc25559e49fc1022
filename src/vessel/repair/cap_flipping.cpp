#include "vessel/repair/cap_flipping.h"

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

constexpr int kMostRounds = 200;  // in a row of caps each round turns the outermost
constexpr double kGain = 1.01;    // of height, that is no rounding

/** Twice the area, along the normal [m²]. */
Eigen::Vector3d areaVector(const geometry::TriangleMesh& mesh, const Eigen::Vector3i& triangle)
{
  const auto corner = [&](int k) { return mesh.vertices[static_cast<std::size_t>(triangle[k])]; };
  return (corner(1) - corner(0)).cross(corner(2) - corner(0));
}

struct Base
{
  int side;       // the triangle's longest; joins corner side and corner (side + 1) % 3
  double height;  // over it [m]
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

bool isEdge(const std::vector<geometry::EdgeUse>& uses, const Diagonal& edge)
{
  const auto use = std::lower_bound(uses.begin(), uses.end(), edge,
                                    [](const geometry::EdgeUse& u, const Diagonal& wanted)
                                    { return std::pair(u.low, u.high) < wanted; });
  return use != uses.end() && use->low == edge.first && use->high == edge.second;
}

/** Turns the edge between two triangles, where both stay on their side and the lower one becomes higher.
 *  @return whether it did */
bool turnEdge(geometry::TriangleMesh& mesh, const geometry::EdgeUse& of_cap, const geometry::EdgeUse& beside)
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

/** Turns the edges of caps that do not touch each other. */
int flipOnce(geometry::TriangleMesh& mesh, double least_height)
{
  std::vector<int> base_side(mesh.triangles.size(), -1);
  bool any = false;
  for (std::size_t t = 0; t < base_side.size(); ++t)
  {
    const Base base = baseOf(mesh, mesh.triangles[t]);
    if (base.height < least_height)
      base_side[t] = base.side, any = true;
  }
  if (!any)
    return 0;
  const std::vector<geometry::EdgeUse> uses = geometry::sortedEdgeUses(mesh);
  std::vector<bool> turned(mesh.triangles.size(), false);
  std::set<Diagonal> made;
  int count = 0;
  for (std::size_t begin = 0; begin < uses.size(); begin = geometry::endOfEdge(uses, begin))
  {
    if (geometry::endOfEdge(uses, begin) - begin != 2)
      continue;
    const geometry::EdgeUse* cap = &uses[begin];
    const geometry::EdgeUse* beside = &uses[begin + 1];
    const auto at = [](const geometry::EdgeUse* use) { return static_cast<std::size_t>(use->triangle); };
    if (base_side[at(cap)] != cap->side)
      std::swap(cap, beside);
    // Two caps side by side do not tell which way the surface looks; one of them stands beside another triangle.
    if (base_side[at(cap)] != cap->side || base_side[at(beside)] >= 0 || cap->forward == beside->forward ||
        turned[at(cap)] || turned[at(beside)])
      continue;
    const int c = mesh.triangles[at(cap)][(cap->side + 2) % 3];
    const int d = mesh.triangles[at(beside)][(beside->side + 2) % 3];
    const Diagonal diagonal = std::minmax(c, d);
    if (c == d || isEdge(uses, diagonal) || made.count(diagonal) > 0 || !turnEdge(mesh, *cap, *beside))
      continue;
    made.insert(diagonal);
    turned[at(cap)] = turned[at(beside)] = true;
    ++count;
  }
  return count;
}

}  // namespace

int flipCaps(geometry::TriangleMesh& mesh, double least_height)
{
  int count = 0;
  for (int round = 0; round < kMostRounds; ++round)
  {
    const int turned = flipOnce(mesh, least_height);
    count += turned;
    if (turned == 0)
      break;
  }
  return count;
}

}  // namespace endovascular_sim::vessel
