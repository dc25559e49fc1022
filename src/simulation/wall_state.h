#pragma once

#include <string>

#include "intervention/vessel_dilatation.h"
#include "intervention/wall_displacement.h"
#include "simulation/wall_history.h"

namespace endovascular_sim::simulation
{

/** State of a wall that balloons deform, the same bytes in every process that keeps one.
 *  @param history its base is the version that contact detection searches
 *  @param detected displacement of that version from the initial wall */
std::string wallState(intervention::VesselDilatation& opening, WallHistory<intervention::WallDisplacement>& history,
                      intervention::WallDisplacement& detected);

/** Loads a state of wallState().
 *  @throws ArchiveError for a state that is damaged or of a vessel with fewer vertices; the arguments are then
 * undefined
 */
void loadWallState(const std::string& state, intervention::VesselDilatation& opening,
                   WallHistory<intervention::WallDisplacement>& history, intervention::WallDisplacement& detected);

}  // namespace endovascular_sim::simulation
