#pragma once

#include <optional>

#include "procedure/observation.h"
#include "procedure/route.h"

namespace endovascular_sim::procedure
{

/** Correction of the motion of an instrument with a bent tip near a junction. */
struct TipSteering
{
  double turn_speed = 0.0;   ///< rotation speed that turns the bend along the route [rad/s]
  double speed_share = 1.0;  ///< share of the insertion speed until the bend points there [1]
};

/** Steering of a bent tip along a route; nothing away from junctions, or where the bend points along the route.
 *  @param max_turn largest rotation speed [rad/s] */
std::optional<TipSteering> steeringOf(const Route& route, const InstrumentView& view, double max_turn);

}  // namespace endovascular_sim::procedure
