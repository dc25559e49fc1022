#pragma once

#include <cstdint>
#include <vector>

#include "endovascular_sim/ContactForceMap.h"
#include "results/wall_force_map.h"

namespace endovascular_sim::nodes
{

/** Region in its message representation: 65535 for none. */
std::uint16_t regionToMessage(int region);
int regionFromMessage(std::uint16_t region);

/** Converts the forces on the wall: totals bit for bit, triangles in single precision. The caller sets the header, the
 *  step and the content hash. */
void toMessage(const results::WallForceSummary& summary, const std::vector<results::WallForce>& touched,
               ContactForceMap& message);
results::WallForceSummary summaryFromMessage(const ContactForceMap& message);
/** @return the triangles that all lists of the message contain */
std::vector<results::WallForce> touchedFromMessage(const ContactForceMap& message);

}  // namespace endovascular_sim::nodes
