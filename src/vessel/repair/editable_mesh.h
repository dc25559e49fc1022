#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Closed two-manifold mesh with edge splits, collapses and flips. Operations that would violate manifoldness are
 *  rejected, so the topology is preserved. */
class EditableMesh
{
public:
  explicit EditableMesh(const geometry::TriangleMesh& mesh);

  /** Copy of the mesh without removed triangles and vertices. */
  geometry::TriangleMesh compact() const;

  int vertexCount() const { return static_cast<int>(positions_.size()); }
  int triangleCount() const { return static_cast<int>(triangles_.size()); }
  bool aliveVertex(int v) const { return !around_[static_cast<std::size_t>(v)].empty(); }
  bool aliveTriangle(int t) const { return triangles_[static_cast<std::size_t>(t)][0] >= 0; }
  const Eigen::Vector3i& triangle(int t) const { return triangles_[static_cast<std::size_t>(t)]; }
  const Eigen::Vector3d& position(int v) const { return positions_[static_cast<std::size_t>(v)]; }
  void move(int v, const Eigen::Vector3d& p) { positions_[static_cast<std::size_t>(v)] = p; }

  /** Triangles adjacent to a vertex. */
  const std::vector<int>& around(int v) const { return around_[static_cast<std::size_t>(v)]; }
  int degree(int v) const { return static_cast<int>(around(v).size()); }

  /** Adjacent vertices, ascending. */
  std::vector<int> neighbours(int v) const;

  /** Triangles adjacent to an edge, −1 for a missing one. */
  std::array<int, 2> trianglesAt(int a, int b) const;

  /** Corner of a triangle opposite to the edge (a, b). */
  int opposite(int t, int a, int b) const;

  /** Splits an edge by a vertex at p.
   *  @return index of the new vertex */
  int split(int a, int b, const Eigen::Vector3d& p);

  /** Link condition of an edge collapse: a and b have exactly two common neighbours. */
  bool canCollapse(int a, int b) const;

  /** Collapses the edge (a, b) into vertex b at p.
   *  @pre canCollapse(a, b) */
  void collapse(int a, int b, const Eigen::Vector3d& p);

  /** Flips an edge.
   *  @return false if the flip would violate manifoldness, for instance because the flipped edge exists */
  bool flip(int a, int b);

  /** Area vector of a triangle times two, with vertex @p moved at @p p. */
  Eigen::Vector3d areaNormal(int t, int moved = -1, const Eigen::Vector3d& p = Eigen::Vector3d::Zero()) const;

private:
  void setTriangle(int t, const Eigen::Vector3i& corners);
  void detach(int t, int v);
  void removeTriangle(int t);

  std::vector<Eigen::Vector3d> positions_;
  std::vector<Eigen::Vector3i> triangles_;  ///< first index −1 for a removed triangle
  std::vector<std::vector<int>> around_;    ///< adjacent triangles of each vertex
};

}  // namespace endovascular_sim::vessel
