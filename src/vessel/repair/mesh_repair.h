#pragma once

#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** A mesh that is fit for use, and what was done to it. */
struct RepairedMesh
{
  geometry::TriangleMesh mesh;
  std::vector<std::string> notes;  ///< one sentence per repair; empty when nothing was wrong
};

/** Vertices closer than this are one [m]. */
constexpr double kWeldDistance = 1e-7;

/** Repairs what is safe: joins vertices closer than kWeldDistance, turns edges of faces lower than that, drops faces
 * without area, duplicate faces and unused vertices, parts sheets that touch in a vertex, turns faces so that all point
 * out of the lumen, drops crumbs that enclose less than a millionth of the vessel, closes ends that are cut across flat
 * by lids. Shapes are never invented: other holes, non-manifold edges and several lumens are refused.
 *  @param source names the mesh in errors
 *  @throws InputError with the count and place of every defect that stays */
RepairedMesh repairMesh(geometry::TriangleMesh mesh, const std::string& source);

/** Turns faces to agree with the first one of their component. @return how many (of the minority), or −1 for a
 * one-sided surface, some of whose faces are then unturned */
int alignFaces(geometry::TriangleMesh& mesh);

}  // namespace endovascular_sim::vessel
