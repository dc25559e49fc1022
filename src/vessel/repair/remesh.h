#pragma once

#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** A place on the wall. */
struct WallPoint
{
  Eigen::Vector3d position;  ///< [m]
  Eigen::Vector3d normal;    ///< unit, out of the lumen
  double facet;              ///< edge length that the mesh should have there [m]
};

/** A surface that points near it can be laid onto. */
class RemeshWall
{
public:
  virtual ~RemeshWall() = default;
  virtual WallPoint onWall(const Eigen::Vector3d& p) const = 0;
};

/** Makes the triangles of a closed two-manifold mesh even, at the wall's facet length, with every vertex on the wall.
 *
 *  Splits, collapses and flips of edges that keep the topology, tangential smoothing, and projection on the wall
 *  (M. Botsch, L. Kobbelt, "A remeshing approach to multiresolution modeling", 2004, with lengths that vary).
 *  @param rounds of all that; fewer suffice for a mesh that is nearly even */
geometry::TriangleMesh remesh(const geometry::TriangleMesh& mesh, const RemeshWall& wall, int rounds = 6);

/** The same for a part of a mesh: vertices that do not take part stay where they are, and so do all triangles between
 *  them.
 *  @param takes_part per vertex, 1 or 0; new vertices take part where the wall's facet length is positive */
geometry::TriangleMesh remeshPart(const geometry::TriangleMesh& mesh, const RemeshWall& wall,
                                  const std::vector<char>& takes_part, int rounds = 6);

}  // namespace endovascular_sim::vessel
