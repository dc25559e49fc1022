#pragma once

#include <vector>

#include <Eigen/Core>

#include "geometry/mesh_distance.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::geometry
{

/** Unit normals at the vertices, from the faces round them by area. */
std::vector<Eigen::Vector3d> vertexNormals(const TriangleMesh& mesh);

/** Weights of a triangle's corners at a point on it; a third each where it has no area. */
Eigen::Vector3d barycentric(const TriangleMesh& mesh, const ClosestPoint& at);

/** The vertices' normals, interpolated. */
Eigen::Vector3d normalAt(const TriangleMesh& mesh, const std::vector<Eigen::Vector3d>& normals, const ClosestPoint& at);

/** A mesh of fine even triangles that tells on which side a point lies. Keeps a reference to the mesh. */
class SidedMesh
{
public:
  explicit SidedMesh(const TriangleMesh& mesh) : mesh_(mesh), distance_(mesh), normals_(vertexNormals(mesh)) {}

  /** Distance to the mesh, negative on the side away from the normals [m]; its sign may be wrong closer to a crease
   *  than the triangles are long. */
  double at(const Eigen::Vector3d& p) const;

  const MeshDistance& distance() const { return distance_; }

private:
  const TriangleMesh& mesh_;
  MeshDistance distance_;
  std::vector<Eigen::Vector3d> normals_;
};

}  // namespace endovascular_sim::geometry
