#include "results/session_sample.h"

#include <algorithm>
#include <cmath>

namespace endovascular_sim::results
{

FaultCounts faultsOf(const rod::StepReport& report)
{
  return {report.solved ? 0U : 1U, report.first_stale_pass != contact::kNoStalePass ? 1U : 0U};
}

void addStep(WallForceMap& map, const simulation::Simulation& simulation,
             const std::vector<simulation::WallContact>& contacts, double dt)
{
  static const std::vector<simulation::WallContact> kNone;
  map.add(faultsOf(simulation.report()).any() ? kNone : contacts, simulation.time(), dt);
}

int foremostOf(const procedure::Observation& observation)
{
  const auto further = [](const procedure::InstrumentView& a, const procedure::InstrumentView& b)
  { return a.hand.insertion < b.hand.insertion; };
  return static_cast<int>(std::max_element(observation.instruments.begin(), observation.instruments.end(), further) -
                          observation.instruments.begin());
}

void Sample::addContact(const Eigen::Vector3d& position, double force)
{
  wall_force += force;
  largest = std::max(largest, force);
  const procedure::InstrumentView& foremost =
      observation.instruments[static_cast<std::size_t>(foremostOf(observation))];
  if ((position - foremost.tip).norm() < kTipReach)
    at_tip += force;
}

bool Sample::isFinite() const
{
  const auto isFiniteView = [](const procedure::InstrumentView& view)
  {
    return std::isfinite(view.hand.insertion) && std::isfinite(view.hand.rotation) && std::isfinite(view.hand.force) &&
           std::isfinite(view.hand.torque) && std::isfinite(view.hand.pressure) && view.tip.allFinite();
  };
  return std::isfinite(observation.time) && std::isfinite(wall_force) && std::isfinite(largest) &&
         std::isfinite(at_tip) &&
         std::all_of(observation.instruments.begin(), observation.instruments.end(), isFiniteView);
}

std::int64_t SessionSampler::intervalAt(double time)
{
  // The small term assigns a time at a boundary to the interval that begins there, despite rounding.
  return static_cast<std::int64_t>(std::floor(time * kRate + 1e-6));
}

bool SessionSampler::addStep(const scene::Scene& scene, const simulation::Simulation& simulation,
                             const std::vector<simulation::WallContact>& contacts)
{
  const FaultCounts faults = faultsOf(simulation.report());
  faults_.rejected_steps += faults.rejected_steps;
  faults_.stale_steps += faults.stale_steps;
  const std::int64_t interval = intervalAt(simulation.time());
  if (interval == interval_)
    return false;
  interval_ = interval;
  sample_ = Sample();
  sample_.observation = procedure::observe(scene, simulation);
  sample_.faults = faults_;
  faults_ = FaultCounts();
  for (const simulation::WallContact& contact : contacts)
    sample_.addContact(contact.position, contact.normal_force.norm());
  return true;
}

}  // namespace endovascular_sim::results
