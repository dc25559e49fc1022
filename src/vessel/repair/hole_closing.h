#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** A hole that was given a lid. */
struct ClosedHole
{
  int edges = 0;                                    ///< of its rim
  double perimeter = 0.0;                           ///< [m]
  double area = 0.0;                                ///< of the lid [m²]
  double unevenness = 0.0;                          ///< largest distance of the rim from its mean plane [m]
  bool simple = false;                              ///< the rim is one loop that the lid covers without folds
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< centre of the rim [m]
};

/** A mesh whose holes have lids: the lids' triangles stand last, their centres are the last vertices. */
struct ClosedMesh
{
  geometry::TriangleMesh mesh;
  std::size_t first_lid = 0;      ///< index of the first triangle of a lid
  std::vector<ClosedHole> holes;  ///< by the smallest vertex of the rim
};

/** Gives every connected rim (edges of one face only) a lid of triangles from its edges to its centre, turned like the
 *  faces at the rim. A rim that branches, at non-manifold edges, is covered by the same fan. */
ClosedMesh closeHoles(geometry::TriangleMesh mesh);

/** Whether the hole is the end of a vessel cut across: one loop of at least eight edges, flat within a thousandth of
 * its perimeter. */
bool isFlatEnd(const ClosedHole& hole);

}  // namespace endovascular_sim::vessel
