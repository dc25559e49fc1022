#pragma once

#include "geometry/triangle_mesh.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::vessel
{

/** Extracts the centreline tree from any closed mesh, without seeds.
 *
 *  Inscribed balls in the middle of the lumen make a graph (balls that overlap belong to one lumen), so that the
 *  resolution follows the vessel's radius. In it, branches are found farthest first: minimal paths of ∫ds/r², each
 *  taking what lies around it out of the search (after M. Sato et al., "TEASAR: tree-structure extraction algorithm for
 *  accurate and robust skeletons", 2000). The lines are then moved onto the ridge of the distance to the wall. The
 *  root is the widest end; ends reach to the wall's cap. Where vessels form a loop (the circle of Willis) the
 *  tree is cut and the cut tip laid onto the other branch.
 *
 *  The time grows with the number of triangles: about 5 µs each. Deterministic.
 *  @pre the mesh has passed checkMesh
 *  @throws InputError when there is no lumen to be found */
CentrelineTree extractCentreline(const geometry::TriangleMesh& mesh);

}  // namespace endovascular_sim::vessel
