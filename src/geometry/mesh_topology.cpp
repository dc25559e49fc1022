#include "geometry/mesh_topology.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace endovascular_sim::geometry
{

namespace
{

bool precedes(const HalfEdge& x, const HalfEdge& y)
{
  return std::tie(x.low, x.high, x.triangle, x.side) < std::tie(y.low, y.high, y.triangle, y.side);
}

/** Sorts half-edges by the low vertex first, by counting: a vertex has few of them.
 *  @param vertices number of vertices, above all indices */
std::vector<HalfEdge> sortedByCounting(const std::vector<HalfEdge>& half_edges, std::size_t vertices)
{
  std::vector<std::size_t> begin(vertices + 1, 0);
  for (const HalfEdge& edge : half_edges)
    ++begin[static_cast<std::size_t>(edge.low) + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  std::vector<HalfEdge> sorted(half_edges.size());
  for (const HalfEdge& edge : half_edges)
    sorted[next[static_cast<std::size_t>(edge.low)]++] = edge;
  for (std::size_t v = 0; v < vertices; ++v)
    std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(begin[v]),
              sorted.begin() + static_cast<std::ptrdiff_t>(begin[v + 1]), precedes);
  return sorted;
}

}  // namespace

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
  const auto vertices = static_cast<int>(mesh.vertices.size());
  if (std::all_of(half_edges.begin(), half_edges.end(),
                  [vertices](const HalfEdge& edge) { return edge.low >= 0 && edge.high < vertices; }))
    return sortedByCounting(half_edges, mesh.vertices.size());
  std::sort(half_edges.begin(), half_edges.end(), precedes);  // a mesh with invalid indices
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

std::vector<int> cornerFans(const TriangleMesh& mesh, const std::vector<HalfEdge>& half_edges)
{
  DisjointSets corners(3 * mesh.triangles.size());
  const auto cornerAt = [&mesh](const HalfEdge& half_edge, int vertex)
  {
    const bool first = mesh.triangles[static_cast<std::size_t>(half_edge.triangle)][half_edge.side] == vertex;
    return 3 * half_edge.triangle + (first ? half_edge.side : (half_edge.side + 1) % 3);
  };
  for (std::size_t begin = 0; begin < half_edges.size();)
  {
    const std::size_t end = endOfEdge(half_edges, begin);
    for (std::size_t k = begin + 1; k < end; ++k)
      for (int vertex : {half_edges[begin].low, half_edges[begin].high})
        corners.join(cornerAt(half_edges[begin], vertex), cornerAt(half_edges[k], vertex));
    begin = end;
  }
  std::vector<int> fans(3 * mesh.triangles.size());
  for (std::size_t c = 0; c < fans.size(); ++c)
    fans[c] = corners.find(static_cast<int>(c));
  return fans;
}

std::vector<int> nonManifoldVertices(const TriangleMesh& mesh, const std::vector<HalfEdge>& half_edges)
{
  const std::vector<int> fans = cornerFans(mesh, half_edges);
  std::vector<int> first(mesh.vertices.size(), -1);
  std::vector<bool> found(mesh.vertices.size(), false);
  std::vector<int> vertices;
  for (std::size_t c = 0; c < fans.size(); ++c)
  {
    const int vertex = mesh.triangles[c / 3][static_cast<int>(c % 3)];
    const auto v = static_cast<std::size_t>(vertex);
    if (first[v] < 0)
      first[v] = fans[c];
    if (first[v] == fans[c] || found[v])
      continue;
    found[v] = true;
    vertices.push_back(vertex);
  }
  return vertices;
}

}  // namespace endovascular_sim::geometry
