#pragma once

#include "endovascular_sim/RodStateVisual.h"
#include "simulation/simulation.h"

namespace endovascular_sim::nodes
{

/** State of the instruments after the last step; the caller sets the header.
 *  @pre the simulation has made a step */
void toMessage(const simulation::Simulation& simulation, RodStateVisual& message);

}  // namespace endovascular_sim::nodes
