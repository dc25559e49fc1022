#pragma once

#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "endovascular_sim/VesselMoved.h"
#include "endovascular_sim/VesselPressing.h"
#include "intervention/vessel_opening.h"
#include "vessel/centreline.h"
#include "vessel/mesh.h"

namespace endovascular_sim::nodes
{

/** Vessels as messages, every number bit for bit; headers, versions, hashes and sources are left to the caller. */
void toMessage(const vessel::TriangleMesh& mesh, VesselMesh& message);
vessel::TriangleMesh fromMessage(const VesselMesh& message);
void toMessage(const vessel::CentrelineTree& tree, VesselCentreline& message);
void toMessage(const std::vector<vessel::PlacedLesion>& lesions, VesselCentreline& message);
/** @throws InputError when a lesion is on a branch that is not there */
std::vector<vessel::PlacedLesion> lesionsFromMessage(const VesselCentreline& message);
vessel::CentrelineTree fromMessage(const VesselCentreline& message);
void toMessage(const intervention::Pressing& pressing, VesselPressing& message);
/** @throws InputError when axes and radii do not fit together */
intervention::Pressing pressingFromMessage(const VesselPressing& message);
void toMessage(const intervention::MovedVertices& moved, VesselMoved& message);
/** @param vertices of the mesh
 *  @throws InputError for a vertex that does not exist, a place that is no number, or lists of different lengths */
intervention::MovedVertices fromMessage(const VesselMoved& message, std::size_t vertices);

}  // namespace endovascular_sim::nodes
