#pragma once

#include <cstdint>
#include <vector>

#include "endovascular_sim/ContactForceMap.h"
#include "results/wall_force_map.h"

namespace endovascular_sim::nodes
{

/** A region as messages tell it: 65535 for none. */
std::uint16_t regionToMessage(int region);
int regionFromMessage(std::uint16_t region);

/** What the wall has borne as a message, totals bit for bit, triangles in single precision; the header, the step and
 *  the mesh's hash are left to the caller. */
void toMessage(const results::WallForceSummary& summary, const std::vector<results::WallForce>& touched,
               ContactForceMap& message);
results::WallForceSummary summaryFromMessage(const ContactForceMap& message);
/** @return the triangles that every list of the message speaks of */
std::vector<results::WallForce> touchedFromMessage(const ContactForceMap& message);

}  // namespace endovascular_sim::nodes
