#include "geometry/vertex_normals.h"

#include <cmath>

#include <gtest/gtest.h>

namespace endovascular_sim::geometry
{
namespace
{

/** A cube of edge 2 around the origin; each face is cut along one of its diagonals. */
TriangleMesh cube()
{
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.vertices.emplace_back(k % 2 == 0 ? -1.0 : 1.0, k / 2 % 2 == 0 ? -1.0 : 1.0, k < 4 ? -1.0 : 1.0);
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TEST(VertexNormals, WeightedByAnglesDoNotDependOnTheDiagonalsOfTheFaces)
{
  const TriangleMesh mesh = cube();
  const std::vector<Eigen::Vector3d> normals = angleWeightedNormals(mesh);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    EXPECT_LT((normals[v] - mesh.vertices[v] / std::sqrt(3.0)).norm(), 1e-15);
}

}  // namespace
}  // namespace endovascular_sim::geometry
