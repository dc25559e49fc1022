#include "geometry/mesh_topology.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace endovascular_sim::geometry
{

std::vector<EdgeUse> sortedEdgeUses(const TriangleMesh& mesh)
{
  std::vector<EdgeUse> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int side = 0; side < 3; ++side)
    {
      const int a = mesh.triangles[t][side];
      const int b = mesh.triangles[t][(side + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), static_cast<int>(t), side, a < b});
    }
  std::sort(uses.begin(), uses.end(),
            [](const EdgeUse& x, const EdgeUse& y)
            { return std::tie(x.low, x.high, x.triangle, x.side) < std::tie(y.low, y.high, y.triangle, y.side); });
  return uses;
}

std::size_t endOfEdge(const std::vector<EdgeUse>& uses, std::size_t begin)
{
  std::size_t end = begin + 1;
  while (end < uses.size() && uses[end].low == uses[begin].low && uses[end].high == uses[begin].high)
    ++end;
  return end;
}

DisjointSets::DisjointSets(std::size_t size) : parent_(size)
{
  std::iota(parent_.begin(), parent_.end(), 0);
}

int DisjointSets::find(int element)
{
  while (parent_[static_cast<std::size_t>(element)] != element)
  {
    int& up = parent_[static_cast<std::size_t>(element)];
    up = parent_[static_cast<std::size_t>(up)];
    element = up;
  }
  return element;
}

void DisjointSets::join(int a, int b)
{
  a = find(a);
  b = find(b);
  parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
}

std::vector<int> triangleComponents(const TriangleMesh& mesh, const std::vector<EdgeUse>& uses)
{
  DisjointSets sets(mesh.triangles.size());
  for (std::size_t begin = 0; begin < uses.size();)
  {
    const std::size_t end = endOfEdge(uses, begin);
    for (std::size_t k = begin + 1; k < end; ++k)
      sets.join(uses[begin].triangle, uses[k].triangle);
    begin = end;
  }
  std::vector<int> component(mesh.triangles.size());
  for (std::size_t t = 0; t < component.size(); ++t)
    component[t] = sets.find(static_cast<int>(t));
  return component;
}

}  // namespace endovascular_sim::geometry
