#pragma once

#include "visualization/instrument_tubes.h"

namespace endovascular_sim::visualization
{

/** Inserts points where a wire turns, so that a tube of few nodes looks smooth: cubic Hermite curves through the nodes,
 *  whose tangents are the bisectors of the adjacent segments. Radii and forces are linear between the nodes.
 *  @param state valid (problemOfWire())
 *  @param largest_turn angle between adjacent segments that is sought [rad]; at most eight parts per segment
 *  @param refined receives the wire; keeps its capacity. All nodes remain */
void refineWire(const WireState& state, double largest_turn, WireState& refined);

}  // namespace endovascular_sim::visualization
