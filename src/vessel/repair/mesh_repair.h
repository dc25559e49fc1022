#pragma once

#include <string>
#include <vector>

#include "common/progress.h"
#include "geometry/triangle_mesh.h"

namespace endovascular_sim::vessel
{

/** Repaired mesh with the log of its repairs. */
struct RepairedMesh
{
  geometry::TriangleMesh mesh;
  std::vector<std::string> notes;  ///< one per kind of repair; empty for a clean mesh
};

/** Distance below which vertices are welded [m]. */
constexpr double kWeldDistance = 1e-7;

/** Applies safe repairs:
 *  - welds vertices closer than kWeldDistance;
 *  - flips the edges of caps lower than kWeldDistance;
 *  - drops degenerate faces, duplicate faces, unused vertices and crumbs below a millionth of the vessel's volume;
 *  - splits vertices that are shared by two sheets;
 *  - orients all faces out of the lumen;
 *  - closes planar ends by lids.
 *
 *  Other holes, non-manifold edges and several lumens are rejected, because their repair would invent geometry.
 *  @param source name of the mesh in errors
 *  @throws InputError with number and location of every remaining defect */
RepairedMesh repairMesh(geometry::TriangleMesh mesh, const std::string& source, const ProgressReport& progress = {});

/** Orients the faces of each component like its first face.
 *  @return number of misoriented faces (the minority); −1 for a one-sided surface, which is unchanged */
int alignFaces(geometry::TriangleMesh& mesh);

}  // namespace endovascular_sim::vessel
