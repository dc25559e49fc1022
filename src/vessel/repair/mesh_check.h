#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Number of occurrences of a defect, with the location of the first one. */
struct MeshDefect
{
  int count = 0;
  Eigen::Vector3d location = Eigen::Vector3d::Zero();  ///< location of the first occurrence [m]

  /** Adds an occurrence. */
  void add(const Eigen::Vector3d& where)
  {
    if (count++ == 0)
      location = where;
  }
};

/** Connected component of a mesh (connected over edges). */
struct MeshComponent
{
  int triangles = 0;
  double volume = 0.0;                                 ///< signed volume [m³]
  Eigen::Vector3d location = Eigen::Vector3d::Zero();  ///< corner of the first triangle [m]
};

/** Defects and global properties of a mesh. */
struct MeshReport
{
  MeshDefect boundary_edges;              ///< edges of one face
  MeshDefect non_manifold_edges;          ///< edges of three or more faces
  MeshDefect misoriented_edges;           ///< edges with two inconsistently oriented faces
  MeshDefect non_manifold_vertices;       ///< vertices shared by several fans of faces
  MeshDefect degenerate_faces;            ///< faces with a repeated vertex or without area
  MeshDefect duplicate_faces;             ///< faces with the same three vertices as an earlier face
  MeshDefect unused_vertices;             ///< vertices without faces
  MeshDefect invalid_faces;               ///< faces with an invalid index, vertices with a non-finite coordinate
  std::vector<MeshComponent> components;  ///< by decreasing number of triangles
  double signed_volume = 0.0;             ///< [m³]; negative if faces point inward
  int genus = 0;                          ///< total genus of all components; valid only without the defects above
  Eigen::Vector3d lower = Eigen::Vector3d::Zero();  ///< bounding box [m]
  Eigen::Vector3d upper = Eigen::Vector3d::Zero();

  /** True for a watertight, outward oriented two-manifold of one component, without degenerate, duplicate or unused
   *  elements. */
  bool clean() const;

  /** Human-readable list of all defects; empty for a clean mesh. */
  std::string summary() const;
};

/** Checks a mesh. The cost is O(n log n) in the number of triangles. */
MeshReport checkMesh(const geometry::TriangleMesh& mesh);

/** Requires a clean mesh.
 *  @throws InputError naming @p source and all defects */
void requireClean(const MeshReport& report, const std::string& source);

/** Formats a position as "(12.3, −4, 5.6) mm". */
std::string formatLocation(const Eigen::Vector3d& location);

}  // namespace endovascular_sim::vessel
