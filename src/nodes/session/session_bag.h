#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "endovascular_sim/DriveApplied.h"
#include "endovascular_sim/SessionInfo.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"

namespace endovascular_sim::nodes
{

/** Content of a recorded session that a replay needs. */
struct SessionBag
{
  SessionInfo info;
  VesselMeshConstPtr mesh;              ///< initial wall; null without a vessel
  VesselCentrelineConstPtr centreline;  ///< null without a vessel
  std::map<std::uint64_t, DriveAppliedConstPtr> steps;
};

/** Reads a bag of the session node.
 *  @throws InputError when it holds no session, or a session with another physics number than kPhysicsNumber: the error
 *          names the version and the commit that can replay it */
SessionBag readSessionBag(const std::string& file);

}  // namespace endovascular_sim::nodes
