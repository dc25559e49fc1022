#include "session/observation.h"

#include <algorithm>
#include <cmath>

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
  return insertion > 0.0 ? world_.branches()->at(simulation_.atRest(simulation::pointAt(simulation_, insertion)))
                         : procedure::BranchPosition();
}

const flow::FlowField* Observation::blood() const
{
  return simulation_.blood() != nullptr ? simulation_.blood()->field() : nullptr;
}

double Observation::pressure(int instrument) const
{
  const int line = simulation_.blood() != nullptr ? simulation_.blood()->lineOf(instrument) : -1;
  return line < 0 || blood() == nullptr ? std::nan("") : blood()->readings[static_cast<std::size_t>(line)];
}

double Observation::bloodFlow(const Eigen::Vector3d& point) const
{
  if (blood() == nullptr)
    return std::nan("");
  return simulation_.blood()->places().flowAt(*blood(), simulation_.blood()->paths().locate(simulation_.atRest(point)));
}

double Observation::bloodPressure(const Eigen::Vector3d& point) const
{
  if (blood() == nullptr)
    return std::nan("");
  return simulation_.blood()->places().pressureAt(*blood(),
                                                  simulation_.blood()->paths().locate(simulation_.atRest(point)));
}

const motion::MovingPatient* Observation::motion() const
{
  return simulation_.motion() != nullptr ? &simulation_.motion()->patient() : nullptr;
}

const std::vector<simulation::WallContact>& Observation::forces() const
{
  if (forces_step_ != step())
    simulation::wallContacts(simulation_, forces_);
  forces_step_ = step();
  return forces_;
}

}  // namespace endovascular_sim::session
