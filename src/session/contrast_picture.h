#pragma once

#include "session/world.h"
#include "simulation/fluoroscopy_system.h"
#include "simulation/simulation.h"

namespace endovascular_sim::session
{

/** Sets the contrast medium of a simulation in an X-ray system, at first with the parts of the lumen. Without effect in
 *  a scene without the key `contrast`.
 *  @param system with the vessel of the world */
void setContrast(const World& world, const simulation::Simulation& simulation, simulation::FluoroscopySystem& system);

}  // namespace endovascular_sim::session
