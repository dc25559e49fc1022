#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::contact
{

/** An edge of the wall between two triangles. */
struct WallEdge
{
  std::array<int, 2> vertices{};
  std::array<int, 2> triangles{-1, -1};
  /** Angle between both triangles' normals [rad]; positive where the edge bulges into the lumen (reflex). */
  double reflex_angle = 0.0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< pseudo-normal towards the lumen, unit
  std::array<Eigen::Vector3d, 2> into_triangle;      ///< in each triangle's plane, ⟂ edge, pointing into it, unit

  int otherEnd(int vertex) const { return vertices[0] == vertex ? vertices[1] : vertices[0]; }
};

/** Angle between two unit vectors [rad]. */
inline double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  return std::acos(std::max(-1.0, std::min(1.0, a.dot(b))));
}

/** The vessel's wall with what closest-feature tests need: normals towards the lumen, edges, adjacency.
 *  Angle-weighted pseudo-normals (Bærentzen & Aanæs 2005) give the sign of the distance at edges and vertices. */
class Wall
{
public:
  /** @param mesh watertight and oriented, normals out of the lumen */
  explicit Wall(const geometry::TriangleMesh& mesh);

  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
  std::vector<Eigen::Vector3d> normals;            ///< per triangle, towards the lumen, unit
  std::vector<double> plane_offsets;               ///< normal·x of each triangle's plane [m]
  std::vector<std::array<int, 3>> triangle_edges;  ///< edge k of a triangle joins its corners k and k+1
  std::vector<WallEdge> edges;
  std::vector<Eigen::Vector3d> vertex_normals;  ///< angle-weighted, towards the lumen, unit
  std::vector<std::vector<int>> vertex_edges;   ///< ascending
  std::vector<char> vertex_reflex;              ///< 1 where some edge at the vertex is reflex
  /** Bound of the angle between a vertex's pseudo-normal and the directions, in front of some triangle there, in which
   * points have the vertex as their closest place around it; π/2 where the wall is too rough to say [rad]. */
  std::vector<double> vertex_cone;
  /** Per triangle the curvature tensor of the smooth wall that the mesh stands for: bᵀKb is the curvature along a
   *  tangential unit vector b, positive where the wall is concave as seen from the lumen [1/m]. */
  std::vector<Eigen::Matrix3d> curvature;

  /** The triangle that a vertex belongs to: the first one that it is a corner of. An edge belongs to its first
   * triangle. */
  int ownerOf(int vertex) const { return vertex_triangles_[vertex].front(); }

  /** What a movement of vertices has changed. */
  struct Changes
  {
    std::vector<int> triangles;  ///< with a vertex that moved
    std::vector<int> around;     ///< triangles that share a vertex with one of them, themselves too; in any order
    std::vector<int> edges;      ///< of the triangles around; in any order
  };

  /** Moves vertices; everything is afterwards, bit for bit, as if the wall had been made from the moved mesh. Time
   *  grows with the number of vertices moved only.
   *  @param indices distinct
   *  @param positions [m], as many
   *  @return valid until the next call */
  const Changes& moveVertices(const std::vector<int>& indices, const std::vector<Eigen::Vector3d>& positions);

private:
  static constexpr int kCurvatureRounds = 2;  ///< of neighbours over which curvature is averaged

  /** Integral of the curvature over the wall round a vertex, and that wall's area. */
  struct Bend
  {
    Eigen::Matrix3d bend = Eigen::Matrix3d::Zero();  ///< [m]
    double area = 0.0;                               ///< [m²]
  };

  void connect();
  void finishTriangle(int triangle);
  void finishEdge(WallEdge& edge);
  void finishVertex(int vertex);
  double coneAt(int vertex) const;
  void finishBend(int edge);
  Bend bendAt(int vertex) const;
  Bend widened(int vertex, int round) const;
  void finishCurvature(int triangle);
  void widenToNeighbours(std::vector<int>& around);
  void markMoved(const std::vector<int>& indices, const std::vector<Eigen::Vector3d>& positions);
  void widenChanges();

  /** An edge's share of bend is weight · across acrossᵀ. */
  struct EdgeBend
  {
    Eigen::Vector3d across;  ///< unit
    double weight;           ///< [m]
  };

  std::vector<std::array<double, 3>> angles_;  ///< of every triangle's corners [rad]
  std::vector<double> areas_;                  ///< of the triangles [m²]
  std::vector<EdgeBend> edge_bends_;
  std::vector<std::vector<int>> vertex_triangles_;             ///< ascending
  std::array<std::vector<Bend>, kCurvatureRounds + 1> bends_;  ///< per vertex, by rounds of averaging
  Changes changes_;
  std::vector<int> moved_edges_;  ///< of the triangles with a vertex that moved
  std::vector<int> ring_, curved_;
  std::vector<char> vertex_marked_, triangle_marked_, edge_marked_;
};

}  // namespace endovascular_sim::contact
