#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::geometry
{

/** Half-edge of a triangle, with the vertices of its undirected edge sorted. */
struct HalfEdge
{
  int low = 0;   ///< smaller vertex index
  int high = 0;  ///< larger vertex index
  int triangle = 0;
  int side = 0;          ///< the half-edge joins corner `side` and corner (side + 1) % 3
  bool forward = false;  ///< true if the triangle traverses the edge from low to high
};

/** Half-edges of all triangles, sorted by edge and then by triangle: those of one edge are contiguous. */
std::vector<HalfEdge> sortedHalfEdges(const TriangleMesh& mesh);

/** End of the range of half-edges that share their edge with the one at @p begin. */
std::size_t endOfEdge(const std::vector<HalfEdge>& half_edges, std::size_t begin);

/** Disjoint-set forest (union–find). The representative of a set is its smallest member. */
class DisjointSets
{
public:
  explicit DisjointSets(std::size_t size);
  int find(int element);
  void join(int a, int b);

private:
  std::vector<int> parent_;
};

/** Connected component of each triangle (connected over edges), named by the component's smallest triangle index. */
std::vector<int> triangleComponents(const TriangleMesh& mesh, const std::vector<HalfEdge>& half_edges);

/** Fan of each corner, 3·triangle + index of the corner: the faces of a vertex that are connected over its edges. It is
 *  named by its smallest corner. */
std::vector<int> cornerFans(const TriangleMesh& mesh, const std::vector<HalfEdge>& half_edges);

/** Vertices with several fans, in the order of their second ones; those of a manifold have one. */
std::vector<int> nonManifoldVertices(const TriangleMesh& mesh, const std::vector<HalfEdge>& half_edges);

}  // namespace endovascular_sim::geometry
