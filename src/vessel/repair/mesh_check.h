#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** How often a defect occurs, and where the first one is. */
struct MeshDefect
{
  int count = 0;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< of the first one [m]

  /** Counts one more. */
  void add(const Eigen::Vector3d& where)
  {
    if (count++ == 0)
      place = where;
  }
};

/** A connected piece of a mesh (joined over edges). */
struct MeshComponent
{
  int triangles = 0;
  double volume = 0.0;                              ///< signed [m³]
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< a corner of its first triangle [m]
};

/** What is right and wrong with a mesh. */
struct MeshReport
{
  MeshDefect boundary_edges;         ///< edges of one face: the rim of a hole
  MeshDefect non_manifold_edges;     ///< edges of three or more faces
  MeshDefect misoriented_edges;      ///< edges whose two faces turn opposite ways
  MeshDefect non_manifold_vertices;  ///< vertices where separate fans of faces touch
  MeshDefect degenerate_faces;       ///< a repeated vertex, or no area
  MeshDefect duplicate_faces;        ///< the same three vertices as an earlier face
  MeshDefect unused_vertices;
  MeshDefect invalid_faces;               ///< an index that does not exist, or a coordinate that is not finite
  std::vector<MeshComponent> components;  ///< largest number of triangles first
  double signed_volume = 0.0;             ///< [m³]; negative: faces point inward
  int genus = 0;                          ///< handles, all components together; meaningful without the defects above
  Eigen::Vector3d lower = Eigen::Vector3d::Zero();  ///< bounding box [m]
  Eigen::Vector3d upper = Eigen::Vector3d::Zero();

  /** Watertight, two-manifold, oriented outwards, in one piece, without faces or vertices that do nothing. */
  bool clean() const;

  /** All defects as one text for people; empty when clean. */
  std::string summary() const;
};

/** Looks at everything above. Time grows with n log n. */
MeshReport checkMesh(const geometry::TriangleMesh& mesh);

/** Refuses a bounding box whose longest side is outside of 5 mm to 3 m, and suggests the unit it seems to be in.
 *  @param unit metres per unit of the file with which the mesh was read
 *  @throws InputError naming @p source */
void requirePlausibleSize(const MeshReport& report, double unit, const std::string& source);

/** @throws InputError naming @p source and all defects, unless the mesh is clean */
void requireClean(const MeshReport& report, const std::string& source);

/** "(12.3, −4, 5.6) mm" */
std::string formatPlace(const Eigen::Vector3d& place);

}  // namespace endovascular_sim::vessel
