#include "session/contrast_picture.h"

namespace endovascular_sim::session
{

void setContrast(const World& world, const simulation::Simulation& simulation, simulation::FluoroscopySystem& system)
{
  if (simulation.contrast() == nullptr)
    return;
  if (!system.hasLumen())
    system.setLumen(world.vessel()->centreline, world.contrastVessel().cells, world.lumen());
  system.setContrast(simulation::contrastMedium(simulation));
}

}  // namespace endovascular_sim::session
