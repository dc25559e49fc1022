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

/** Vessels as messages, every number bit for bit; headers, versions, hashes and sources are left to the caller. */
void toMessage(const geometry::TriangleMesh& mesh, VesselMesh& message);
geometry::TriangleMesh fromMessage(const VesselMesh& message);
void toMessage(const vessel::CentrelineTree& tree, VesselCentreline& message);
void toMessage(const std::vector<vessel::PlacedLesion>& lesions, VesselCentreline& message);
/** @throws InputError when a lesion is on a branch that is not there */
std::vector<vessel::PlacedLesion> lesionsFromMessage(const VesselCentreline& message);
vessel::CentrelineTree fromMessage(const VesselCentreline& message);
void toMessage(const intervention::BalloonLoad& pressing, BalloonLoad& message);
/** @throws InputError when axes and radii do not fit together */
intervention::BalloonLoad pressingFromMessage(const BalloonLoad& message);
void toMessage(const intervention::WallDisplacement& moved, WallDisplacement& message);
/** @param vertices of the mesh
 *  @throws InputError for a vertex that does not exist, a place that is no number, or lists of different lengths */
intervention::WallDisplacement fromMessage(const WallDisplacement& message, std::size_t vertices);

}  // namespace endovascular_sim::nodes
