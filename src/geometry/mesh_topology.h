#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::geometry
{

/** One side of a triangle, seen as an undirected edge. */
struct EdgeUse
{
  int low = 0;   ///< smaller vertex index
  int high = 0;  ///< larger vertex index
  int triangle = 0;
  int side = 0;          ///< joins corner `side` and corner (side + 1) % 3
  bool forward = false;  ///< the triangle runs from low to high
};

/** All sides of all triangles, sorted by edge and then by triangle: the uses of an edge stand together. */
std::vector<EdgeUse> sortedEdgeUses(const TriangleMesh& mesh);

/** End of the run of uses of the same edge that begins at @p begin. */
std::size_t endOfEdge(const std::vector<EdgeUse>& uses, std::size_t begin);

/** Sets that merge (union–find); the representative is the smallest member. */
class DisjointSets
{
public:
  explicit DisjointSets(std::size_t size);
  int find(int element);
  void join(int a, int b);

private:
  std::vector<int> parent_;
};

/** Per triangle, the smallest index of a triangle in its component (joined over edges). */
std::vector<int> triangleComponents(const TriangleMesh& mesh, const std::vector<EdgeUse>& uses);

}  // namespace endovascular_sim::geometry
