#pragma once

#include "common/progress.h"
#include "geometry/triangle_mesh.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::vessel
{

/** Extracts the centreline tree of a closed mesh, without seed points.
 *
 *  1. Overlapping medial spheres form a graph, so that the resolution follows the vessel's radius.
 *  2. Branches are minimal paths of ∫ds/r² in the graph, traced from the farthest uncovered sphere. Each path covers
 *     its surroundings (after M. Sato et al., "TEASAR: tree-structure extraction algorithm for accurate and robust
 *     skeletons", 2000).
 *  3. The paths are moved onto the ridge of the distance to the wall and extended to the end caps.
 *
 *  The root is the widest end. A loop of vessels (circle of Willis) is cut, and the cut tip is connected to the other
 *  branch. The result is deterministic; the cost is linear in the number of triangles.
 *  @pre the mesh has passed checkMesh
 *  @throws InputError if no lumen is found */
CentrelineTree extractCentreline(const geometry::TriangleMesh& mesh, const ProgressReport& progress = {});

}  // namespace endovascular_sim::vessel
