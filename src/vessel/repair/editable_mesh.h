#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** A closed two-manifold mesh whose edges can be split, collapsed and flipped. Every operation refuses what would break
 *  the manifold, so the topology stays as it was. */
class EditableMesh
{
public:
  explicit EditableMesh(const geometry::TriangleMesh& mesh);

  /** The mesh without the removed triangles and vertices. */
  geometry::TriangleMesh compact() const;

  int vertexCount() const { return static_cast<int>(positions_.size()); }
  int triangleCount() const { return static_cast<int>(triangles_.size()); }
  bool aliveVertex(int v) const { return !around_[static_cast<std::size_t>(v)].empty(); }
  bool aliveTriangle(int t) const { return triangles_[static_cast<std::size_t>(t)][0] >= 0; }
  const Eigen::Vector3i& triangle(int t) const { return triangles_[static_cast<std::size_t>(t)]; }
  const Eigen::Vector3d& position(int v) const { return positions_[static_cast<std::size_t>(v)]; }
  void move(int v, const Eigen::Vector3d& p) { positions_[static_cast<std::size_t>(v)] = p; }

  /** Triangles round a vertex. */
  const std::vector<int>& around(int v) const { return around_[static_cast<std::size_t>(v)]; }
  int degree(int v) const { return static_cast<int>(around(v).size()); }

  /** Neighbours of a vertex, ascending. */
  std::vector<int> neighbours(int v) const;

  /** The two triangles at an edge. @pre the edge exists */
  std::array<int, 2> trianglesAt(int a, int b) const;

  /** The corner of a triangle that is neither a nor b. */
  int opposite(int t, int a, int b) const;

  /** Puts a vertex on the edge. @return the new vertex */
  int split(int a, int b, const Eigen::Vector3d& p);

  /** Whether a and b can become one: they share exactly the two neighbours opposite of their edge. */
  bool canCollapse(int a, int b) const;

  /** Moves b onto p and makes a into b. @pre canCollapse */
  void collapse(int a, int b, const Eigen::Vector3d& p);

  /** Replaces the edge by the one between the opposite corners; false where that edge exists already. */
  bool flip(int a, int b);

  /** Normal of a triangle, of twice its area's length; @p moved stands at @p p instead. */
  Eigen::Vector3d areaNormal(int t, int moved = -1, const Eigen::Vector3d& p = Eigen::Vector3d::Zero()) const;

private:
  void setTriangle(int t, const Eigen::Vector3i& corners);
  void detach(int t, int v);
  void removeTriangle(int t);

  std::vector<Eigen::Vector3d> positions_;
  std::vector<Eigen::Vector3i> triangles_;  ///< −1 in the first corner: removed
  std::vector<std::vector<int>> around_;
};

}  // namespace endovascular_sim::vessel
