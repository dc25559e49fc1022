#include "geometry/mesh_topology.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace endovascular_sim::geometry
{

std::vector<HalfEdge> sortedHalfEdges(const TriangleMesh& mesh)
{
  std::vector<HalfEdge> half_edges;
  half_edges.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int side = 0; side < 3; ++side)
    {
      const int a = mesh.triangles[t][side];
      const int b = mesh.triangles[t][(side + 1) % 3];
      half_edges.push_back({std::min(a, b), std::max(a, b), static_cast<int>(t), side, a < b});
    }
  std::sort(half_edges.begin(), half_edges.end(),
            [](const HalfEdge& x, const HalfEdge& y)
            { return std::tie(x.low, x.high, x.triangle, x.side) < std::tie(y.low, y.high, y.triangle, y.side); });
  return half_edges;
}

std::size_t endOfEdge(const std::vector<HalfEdge>& half_edges, std::size_t begin)
{
  std::size_t end = begin + 1;
  while (end < half_edges.size() && half_edges[end].low == half_edges[begin].low &&
         half_edges[end].high == half_edges[begin].high)
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

std::vector<int> triangleComponents(const TriangleMesh& mesh, const std::vector<HalfEdge>& half_edges)
{
  DisjointSets sets(mesh.triangles.size());
  for (std::size_t begin = 0; begin < half_edges.size();)
  {
    const std::size_t end = endOfEdge(half_edges, begin);
    for (std::size_t k = begin + 1; k < end; ++k)
      sets.join(half_edges[begin].triangle, half_edges[k].triangle);
    begin = end;
  }
  std::vector<int> component(mesh.triangles.size());
  for (std::size_t t = 0; t < component.size(); ++t)
    component[t] = sets.find(static_cast<int>(t));
  return component;
}

}  // namespace endovascular_sim::geometry
