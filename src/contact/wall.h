#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "vessel/mesh.h"

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
};

/** The vessel's wall with what closest-feature tests need: normals towards the lumen, edges, adjacency.
 *  Angle-weighted pseudo-normals (Bærentzen & Aanæs 2005) give the sign of the distance at edges and vertices. */
class Wall
{
public:
  /** @param mesh watertight and oriented, normals out of the lumen */
  explicit Wall(const vessel::TriangleMesh& mesh);

  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
  std::vector<Eigen::Vector3d> normals;            ///< per triangle, towards the lumen, unit
  std::vector<double> plane_offsets;               ///< normal·x of each triangle's plane [m]
  std::vector<std::array<int, 3>> triangle_edges;  ///< edge k of a triangle joins its corners k and k+1
  std::vector<WallEdge> edges;
  std::vector<Eigen::Vector3d> vertex_normals;  ///< angle-weighted, towards the lumen, unit
  std::vector<std::vector<int>> vertex_edges;
  std::vector<char> vertex_reflex;  ///< 1 where some edge at the vertex is reflex
  /** Per triangle the curvature tensor of the smooth wall that the mesh stands for: bᵀKb is the curvature along a
   *  tangential unit vector b, positive where the wall is concave as seen from the lumen [1/m]. */
  std::vector<Eigen::Matrix3d> curvature;

private:
  void findCurvature();
  void finishEdge(WallEdge& edge);
};

}  // namespace endovascular_sim::contact
