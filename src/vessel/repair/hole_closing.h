#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Hole that was closed by a lid. */
struct ClosedHole
{
  int edges = 0;                                       ///< number of boundary edges
  double perimeter = 0.0;                              ///< length of the rim [m]
  double area = 0.0;                                   ///< area of the lid [m²]
  double unevenness = 0.0;                             ///< largest distance of the rim from its mean plane [m]
  bool simple = false;                                 ///< true if the rim is one loop and the lid has no folds
  Eigen::Vector3d location = Eigen::Vector3d::Zero();  ///< centre of the rim [m]
};

/** Mesh with closed holes. Triangles and centre vertices of the lids are last; a lid may have no centre. */
struct ClosedMesh
{
  geometry::TriangleMesh mesh;
  std::size_t first_lid = 0;      ///< index of the first triangle of a lid
  std::vector<ClosedHole> holes;  ///< ordered by the smallest vertex of the rim
};

/** Closes holes. Every connected rim (edges of one face only) receives a lid: a triangle fan about the rim's centre,
 *  oriented like the adjacent faces. A planar rim that a fan does not fill, such as a C or a D, receives triangles
 *  between its vertices. A branching rim at non-manifold edges receives a fan as well. */
ClosedMesh closeHoles(geometry::TriangleMesh mesh);

/** True if the hole is the planar end of a vessel: one loop of at least eight edges, planar within a thousandth of its
 *  perimeter. */
bool isFlatEnd(const ClosedHole& hole);

}  // namespace endovascular_sim::vessel
