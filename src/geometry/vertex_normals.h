#pragma once

#include <vector>

#include <Eigen/Core>

#include "geometry/mesh_distance.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::geometry
{

/** Unit vertex normals: area-weighted means of the adjacent face normals. */
std::vector<Eigen::Vector3d> vertexNormals(const TriangleMesh& mesh);

/** Unit vertex normals: means of the adjacent face normals, weighted by the angles of the corners. They do not depend
 *  on the triangulation of flat parts (Bærentzen & Aanæs 2005). contact::Wall keeps the same normals, turned to the
 *  lumen, under movements of the wall. */
std::vector<Eigen::Vector3d> angleWeightedNormals(const TriangleMesh& mesh);

/** Barycentric coordinates of a point on a triangle; 1/3 each for a degenerate triangle. */
Eigen::Vector3d barycentric(const TriangleMesh& mesh, const ClosestPoint& at);

/** Unit normal at a point of the mesh, interpolated from vertex normals. */
Eigen::Vector3d normalAt(const TriangleMesh& mesh, const std::vector<Eigen::Vector3d>& normals, const ClosestPoint& at);

/** Signed distance to a fine, isotropic mesh; the sign comes from interpolated vertex normals. Keeps a reference to the
 *  mesh. */
class SignedMeshDistance
{
public:
  explicit SignedMeshDistance(const TriangleMesh& mesh) : mesh_(mesh), distance_(mesh), normals_(vertexNormals(mesh)) {}

  /** Signed distance [m], negative on the inner side. The sign may be wrong within one edge length of a crease. */
  double at(const Eigen::Vector3d& p) const;

  const MeshDistance& distance() const { return distance_; }

private:
  const TriangleMesh& mesh_;
  MeshDistance distance_;
  std::vector<Eigen::Vector3d> normals_;
};

}  // namespace endovascular_sim::geometry
