#pragma once

#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "vessel/centreline.h"
#include "vessel/mesh.h"

namespace endovascular_sim::nodes
{

/** Vessels as messages, every number bit for bit; headers, versions, hashes and sources are left to the caller. */
void toMessage(const vessel::TriangleMesh& mesh, VesselMesh& message);
vessel::TriangleMesh fromMessage(const VesselMesh& message);
void toMessage(const vessel::CentrelineTree& tree, VesselCentreline& message);
vessel::CentrelineTree fromMessage(const VesselCentreline& message);

}  // namespace endovascular_sim::nodes
