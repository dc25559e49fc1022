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

/** Vessel wall with the data of closest-feature tests: normals towards the lumen, edges, adjacency, curvature.
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
  /** Half angle of each vertex's normal cone around its pseudo-normal [rad]. The cone contains the offset of every
   * point in front of a triangle there for which the vertex is a local minimum. π/2 where the wall is too rough for a
   * bound. */
  std::vector<double> vertex_cone;
  /** Curvature tensor K of the underlying smooth wall, per triangle: bᵀKb is the curvature along a tangential unit
   *  vector b, positive where the wall is concave as seen from the lumen [1/m]. */
  std::vector<Eigen::Matrix3d> curvature;

  /** Owner of a vertex: its first triangle. The owner of an edge is its first triangle, too. */
  int ownerOf(int vertex) const { return vertex_triangles_[vertex].front(); }

  /** Features changed by a movement of vertices. */
  struct Changes
  {
    std::vector<int> triangles;  ///< triangles with a moved vertex
    std::vector<int> around;     ///< these and all that share a vertex with one of them; unordered
    std::vector<int> edges;      ///< edges of the triangles around; unordered
  };

  /** Moves vertices. The wall is afterwards, bit for bit, that of the moved mesh. The cost depends on the number of
   *  moved vertices only.
   *  @param indices distinct vertices
   *  @param positions new positions, one per index [m]
   *  @return valid until the next call */
  const Changes& moveVertices(const std::vector<int>& indices, const std::vector<Eigen::Vector3d>& positions);

private:
  static constexpr int kCurvatureRounds = 2;  ///< rounds of averaging of the curvature over neighbours

  /** Integral of the curvature over the wall around a vertex, and the area of that part. */
  struct Bend
  {
    Eigen::Matrix3d bend = Eigen::Matrix3d::Zero();  ///< [m]
    double area = 0.0;                               ///< [m²]
  };

  void connect();
  void updateTriangle(int triangle);
  void updateEdge(WallEdge& edge);
  void updateVertex(int vertex);
  double coneAt(int vertex) const;
  void updateEdgeBend(int edge);
  Bend bendAt(int vertex) const;
  Bend averagedBend(int vertex, int round) const;
  void updateCurvature(int triangle);
  void appendNeighbours(std::vector<int>& around);
  void moveAndMark(const std::vector<int>& indices, const std::vector<Eigen::Vector3d>& positions);
  void collectNeighbours();

  /** Contribution of an edge to the integral of curvature: weight · across acrossᵀ. */
  struct EdgeBend
  {
    Eigen::Vector3d across;  ///< unit
    double weight;           ///< [m]
  };

  std::vector<std::array<double, 3>> angles_;  ///< corner angles of each triangle [rad]
  std::vector<double> areas_;                  ///< area of each triangle [m²]
  std::vector<EdgeBend> edge_bends_;
  std::vector<std::vector<int>> vertex_triangles_;             ///< ascending
  std::array<std::vector<Bend>, kCurvatureRounds + 1> bends_;  ///< per round of averaging and vertex
  Changes changes_;
  std::vector<int> moved_edges_;  ///< edges of the triangles with a moved vertex
  std::vector<int> ring_;         ///< vertices around the moved ones
  std::vector<int> curved_;       ///< triangles whose curvature has changed
  std::vector<char> vertex_marked_, triangle_marked_, edge_marked_;
};

}  // namespace endovascular_sim::contact
