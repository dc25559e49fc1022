#include "session/observation.h"

#include <algorithm>

#include "simulation/instrument_tip.h"

namespace endovascular_sim::session
{

Tip Observation::tip(int instrument) const
{
  return {simulation::pointAt(simulation_, std::max(0.0, hand(instrument).insertion)),
          simulation::tipFrame(simulation_, instrument), simulation::tipRotation(simulation_, instrument)};
}

procedure::BranchPosition Observation::branch(int instrument) const
{
  const double insertion = hand(instrument).insertion;
  return insertion > 0.0 ? world_.branches()->at(simulation::pointAt(simulation_, insertion))
                         : procedure::BranchPosition();
}

const std::vector<simulation::WallContact>& Observation::forces() const
{
  if (forces_step_ != step())
    simulation::wallContacts(simulation_, forces_);
  forces_step_ = step();
  return forces_;
}

}  // namespace endovascular_sim::session
