#include "procedure/observation.h"

#include <algorithm>

#include "simulation/instrument_tip.h"

namespace endovascular_sim::procedure
{

double bentLength(const instrument::Instrument& instrument)
{
  double length = 0.0, bent = 0.0;
  const std::vector<rod::Section>& sections = instrument.wire.sections;
  for (auto section = sections.rbegin(); section != sections.rend(); ++section)
  {
    length += section->length;
    if (!section->rest_curvature.isZero())
      bent = length;
    else if (bent > 0.0)
      break;
  }
  return bent;
}

void markCovered(Observation& observation)
{
  for (std::size_t k = 0; k < observation.instruments.size(); ++k)
    for (std::size_t outer = k + 1; outer < observation.instruments.size(); ++outer)
      observation.instruments[k].covered =
          observation.instruments[k].covered ||
          observation.instruments[outer].hand.insertion > observation.instruments[k].hand.insertion;
}

namespace
{

void observePatient(const simulation::Simulation& simulation, Observation& observation)
{
  observation.hyperaemia = simulation.blood() != nullptr && simulation.blood()->controls().hyperaemia;
  if (simulation.contrast() != nullptr)
  {
    observation.is_injecting = simulation.contrast()->injector().isActive();
    observation.injected_volume = simulation.contrast()->injectedVolume();
  }
  if (simulation.motion() == nullptr)
    return;
  observation.patient_moves = true;
  const motion::MovingPatient& patient = simulation.motion()->patient();
  observation.breath_asked = patient.breath().held();
  observation.breath_held = patient.breath().standing();
  if (simulation.blood() != nullptr && simulation.blood()->controls().heart_rate == 0.0)
    return;  // arrest
  observation.heart.rate = patient.heart().rate();
  observation.heart.phase = patient.heart().phase();
  observation.heart.systole = patient.motion().settings().heart.systolicShare(patient.heart().rate());
}

/** Point of the instruments' centreline, as place in the resting patient [m]. */
Eigen::Vector3d restingPointAt(const simulation::Simulation& simulation, double inserted)
{
  return simulation.atRest(simulation::pointAt(simulation, inserted));
}

}  // namespace

Observation observe(const scene::Scene& scene, const simulation::Simulation& simulation)
{
  Observation observation;
  observation.time = simulation.time();
  observePatient(simulation, observation);
  for (int k = 0; k < simulation.instruments(); ++k)
  {
    InstrumentView view;
    view.hand = simulation.hand(k);
    view.outside = simulation.isOutside(k);
    view.tip = restingPointAt(simulation, std::max(0.0, view.hand.insertion));
    view.tip_rotation = simulation::tipRotation(simulation, k);
    const double bent = bentLength(scene.instruments[static_cast<std::size_t>(k)].instrument);
    if (bent > 0.0 && view.hand.insertion > 2.0 * bent)
    {
      view.bend.length = bent;
      view.bend.base = restingPointAt(simulation, view.hand.insertion - bent);
      view.bend.shaft = (view.bend.base - restingPointAt(simulation, view.hand.insertion - 1.5 * bent)).normalized();
    }
    const auto& balloon = scene.instruments[static_cast<std::size_t>(k)].instrument.balloon;
    const double middle = balloon ? view.hand.insertion - balloon->from_tip - 0.5 * balloon->length : 0.0;
    if (balloon && middle > 0.0)
      view.balloon = restingPointAt(simulation, middle);
    observation.instruments.push_back(view);
  }
  markCovered(observation);
  return observation;
}

void locate(Observation& observation, const BranchLocator& locator)
{
  for (InstrumentView& view : observation.instruments)
    if (view.hand.insertion > 0.0)
      view.branch_position = locator.at(view.tip);
}

Observation observe(const scene::Scene& scene, const simulation::Simulation& simulation, const BranchLocator& locator)
{
  Observation observation = observe(scene, simulation);
  locate(observation, locator);
  return observation;
}

}  // namespace endovascular_sim::procedure
