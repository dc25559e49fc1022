#include "results/session_sample.h"

#include <algorithm>
#include <cmath>

#include "simulation/instrument_tip.h"

namespace endovascular_sim::results
{
namespace
{

/** Tip of the instrument with the largest insertion; the introducer while all are outside [m]. */
Eigen::Vector3d foremostTip(const simulation::Simulation& simulation)
{
  double furthest = 0.0;
  for (int k = 0; k < simulation.instruments(); ++k)
    furthest = std::max(furthest, simulation.hand(k).insertion);
  return simulation::pointAt(simulation, furthest);
}

}  // namespace

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

void WallLoad::add(const Eigen::Vector3d& position, double force, const Eigen::Vector3d& tip)
{
  sum += force;
  largest = std::max(largest, force);
  if ((position - tip).norm() < kTipReach)
    at_tip += force;
}

void Peaks::addHands(const std::vector<double>& forces, const std::vector<double>& torques)
{
  const auto take = [](std::vector<double>& peaks, const std::vector<double>& values)
  {
    peaks.resize(std::max(peaks.size(), values.size()), 0.0);
    for (std::size_t k = 0; k < values.size(); ++k)
      peaks[k] = std::abs(values[k]) > std::abs(peaks[k]) ? values[k] : peaks[k];
  };
  take(hand_force, forces);
  take(hand_torque, torques);
}

void Peaks::add(const simulation::Simulation& simulation, const WallLoad& load)
{
  const auto hands = static_cast<std::size_t>(simulation.instruments());
  hand_force.resize(hands, 0.0);
  hand_torque.resize(hands, 0.0);
  for (std::size_t k = 0; k < hands; ++k)
  {
    const simulation::HandState hand = simulation.hand(static_cast<int>(k));
    hand_force[k] = std::abs(hand.force) > std::abs(hand_force[k]) ? hand.force : hand_force[k];
    hand_torque[k] = std::abs(hand.torque) > std::abs(hand_torque[k]) ? hand.torque : hand_torque[k];
  }
  wall.sum = std::max(wall.sum, load.sum);
  wall.largest = std::max(wall.largest, load.largest);
  wall.at_tip = std::max(wall.at_tip, load.at_tip);
}

bool Sample::isFinite() const
{
  const auto isFiniteView = [](const procedure::InstrumentView& view)
  {
    return std::isfinite(view.hand.insertion) && std::isfinite(view.hand.rotation) && std::isfinite(view.hand.force) &&
           std::isfinite(view.hand.torque) && std::isfinite(view.hand.pressure) && view.tip.allFinite() &&
           std::isfinite(view.tip_rotation);
  };
  const auto isFiniteLoad = [](const WallLoad& load)
  { return std::isfinite(load.sum) && std::isfinite(load.largest) && std::isfinite(load.at_tip); };
  const auto isFiniteValue = [](double value) { return std::isfinite(value); };
  return std::isfinite(observation.time) && isFiniteLoad(wall) && isFiniteLoad(peaks.wall) &&
         std::all_of(peaks.hand_force.begin(), peaks.hand_force.end(), isFiniteValue) &&
         std::all_of(peaks.hand_torque.begin(), peaks.hand_torque.end(), isFiniteValue) &&
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
  const Eigen::Vector3d tip = foremostTip(simulation);
  WallLoad load;
  for (const simulation::WallContact& contact : contacts)
    load.add(contact.position, contact.normal_force.norm(), tip);
  if (!faults.any())
    peaks_.add(simulation, load);
  const std::int64_t interval = intervalAt(simulation.time());
  if (interval == interval_)
    return false;
  interval_ = interval;
  sample_ = Sample();
  sample_.observation = procedure::observe(scene, simulation);
  sample_.wall = load;
  sample_.faults = faults_;
  sample_.peaks = peaks_;
  sample_.peaks.hand_force.resize(sample_.observation.instruments.size(), 0.0);
  sample_.peaks.hand_torque.resize(sample_.observation.instruments.size(), 0.0);
  faults_ = FaultCounts();
  peaks_ = Peaks();
  return true;
}

}  // namespace endovascular_sim::results
