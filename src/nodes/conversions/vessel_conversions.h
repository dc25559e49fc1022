#pragma once

#include "endovascular_sim/BalloonLoad.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "endovascular_sim/WallDisplacement.h"
#include "geometry/triangle_mesh.h"
#include "intervention/vessel_dilatation.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::nodes
{

/** Conversions of vessels, bit for bit. The caller sets headers, versions and sources, and the hash of a centreline. */
void toMessage(const geometry::TriangleMesh& mesh, VesselMesh& message);
/** @throws InputError for a vertex that does not exist or is not finite, and for another content hash */
geometry::TriangleMesh fromMessage(const VesselMesh& message);
void toMessage(const vessel::CentrelineTree& tree, VesselCentreline& message);
void toMessage(const std::vector<vessel::PlacedLesion>& lesions, VesselCentreline& message);
/** @throws InputError when a lesion is on a branch that does not exist */
std::vector<vessel::PlacedLesion> lesionsFromMessage(const VesselCentreline& message);
/** @throws InputError for branches that form no tree, and for points and radii that are not finite */
vessel::CentrelineTree fromMessage(const VesselCentreline& message);
void toMessage(const intervention::BalloonLoad& load, BalloonLoad& message);
/** @throws InputError when an axis and its radii differ in length or are not finite */
intervention::BalloonLoad loadFromMessage(const BalloonLoad& message);
void toMessage(const intervention::WallDisplacement& displacement, WallDisplacement& message);
/** @param vertices number of vertices of the mesh
 *  @throws InputError when a vertex does not exist, a position is not finite, or the lists differ in length */
intervention::WallDisplacement fromMessage(const WallDisplacement& message, std::size_t vertices);

}  // namespace endovascular_sim::nodes
