#include "session/observation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/fluoroscopy_system.h"
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

std::optional<ContrastState> Observation::contrast() const
{
  if (simulation_.contrast() == nullptr)
    return std::nullopt;
  const simulation::ContrastInjections& injections = *simulation_.contrast();
  simulation::ContrastMedium medium = simulation::contrastMedium(simulation_);
  ContrastState state;
  state.cells = std::move(medium.cells);
  state.instruments = std::move(medium.instruments);
  state.rate = injections.rate();
  state.remaining = injections.injector().left();
  state.syringe = injections.injector().content();
  state.volume = injections.injectedVolume();
  if (blood() != nullptr)
    state.iodine = blood()->totals;
  return state;
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
