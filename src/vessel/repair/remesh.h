#pragma once

#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Point of a remeshing target. */
struct TargetPoint
{
  Eigen::Vector3d position;  ///< [m]
  Eigen::Vector3d normal;    ///< unit, out of the lumen
  double edge_length;        ///< target edge length of the mesh [m]; 0 for a fixed region
};

/** Interface to a remeshing target: projection surface with a sizing field. */
class RemeshTarget
{
public:
  virtual ~RemeshTarget() = default;

  /** Projects a nearby point onto the surface. */
  virtual TargetPoint project(const Eigen::Vector3d& p) const = 0;
};

/** Isotropic remeshing of a closed two-manifold mesh onto a target surface with a sizing field.
 *
 *  Edge splits, collapses and flips that preserve the topology, tangential smoothing, and projection (M. Botsch,
 *  L. Kobbelt, "A remeshing approach to multiresolution modeling", 2004).
 *  @param rounds number of iterations; a nearly isotropic mesh needs fewer */
geometry::TriangleMesh remesh(const geometry::TriangleMesh& mesh, const RemeshTarget& target, int rounds = 6);

/** Remeshes a region. Fixed vertices and the triangles between them are unchanged.
 *  @param is_free per vertex, 1 if it may move, else 0; new vertices may move where the target's edge length is
 *           positive */
geometry::TriangleMesh remeshRegion(const geometry::TriangleMesh& mesh, const RemeshTarget& target,
                                    const std::vector<char>& is_free, int rounds = 6);

}  // namespace endovascular_sim::vessel
