#include "benchmark/harness/bench_run.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "results/run_result.h"
#include "simulation/instrument_tip.h"

namespace endovascular_sim::benchmark
{
namespace
{

constexpr double kCheckInterval = 0.1;    // simulated time between checks with the exact distance [s]
constexpr double kBeyondAllBounds = 1e3;  // coordinates of a diverged state [m]

double simulatedMass(const simulation::Simulation& simulation)
{
  const std::vector<double>& mass = simulation.discretisation().mass;
  return std::accumulate(mass.begin() + simulation.state().first_node, mass.end(), 0.0);
}

double kineticEnergy(const simulation::Simulation& simulation)
{
  double energy = 0.0;
  const rod::State& state = simulation.state();
  for (int i = simulation::firstInsertedNode(simulation); i < simulation.discretisation().nodes(); ++i)
    energy += 0.5 * simulation.discretisation().mass[i] * state.velocity[i].squaredNorm();
  return energy;
}

bool isFinite(const rod::State& state)
{
  return std::all_of(state.position.begin() + state.first_node, state.position.end(),
                     [](const Eigen::Vector3d& x) { return x.allFinite() && x.norm() < kBeyondAllBounds; }) &&
         std::isfinite(state.hand_force) && std::isfinite(state.hand_torque);
}

}  // namespace

BenchRun::BenchRun(const std::string& scene_text, const std::vector<std::string>& overrides)
  : session_(session::World::parse(scene_text, "benchmark", overrides))
{
  session_.setLastStep(std::numeric_limits<std::uint64_t>::max());
  resetEnergyBalance();
}

void BenchRun::resetEnergyBalance()
{
  last_insertion_ = simulation().state().inserted_length;
  last_rotation_ = simulation().state().rotation;
  const rod::Energy energy = simulation().energy();
  first_energy_ = energy.bending + energy.twist + kineticEnergy(simulation());
  work_ = 0.0;
  last_mass_ = simulatedMass(simulation());
}

RunSummary BenchRun::advance(double seconds)
{
  RunSummary summary;
  const auto steps = static_cast<int>(std::llround(seconds / scene().solver.time_step));
  const auto check_every = std::max(1, static_cast<int>(std::llround(kCheckInterval / scene().solver.time_step)));
  std::vector<double> times;
  std::array<std::vector<double>, kPhaseCount> phases;
  for (int k = 0; k < steps && summary.finite; ++k)
  {
    session_.step();
    times.push_back(session_.stepSeconds());
    for (std::size_t p = 0; p < kPhaseCount; ++p)
      phases[p].push_back(simulation().timer().seconds(static_cast<Phase>(p)));
    ++summary.steps;
    observe(summary);
    if (k % check_every == 0 || k + 1 == steps)
      checkEnergy(summary);
  }
  const results::DurationStatistics statistics = results::durationStatistics(times);
  summary.mean_us = 1e6 * statistics.mean;
  summary.median_us = 1e6 * statistics.median;
  summary.p99_us = 1e6 * statistics.p99;
  for (std::size_t p = 0; p < kPhaseCount; ++p)
    summary.phase_us[p] = 1e6 * results::durationStatistics(phases[p]).median;
  summary.solves /= std::max(1, summary.steps);
  summary.mean_hand_force /= std::max(1, summary.steps);
  return summary;
}

void BenchRun::observe(RunSummary& summary)
{
  const rod::State& state = simulation().state();
  const rod::StepReport& report = simulation().report();
  summary.rejected += report.solved ? 0 : 1;
  summary.bisections += report.bisections;
  summary.truncated += report.truncations;
  summary.solves += report.solves;
  summary.max_strain = std::max(summary.max_strain, report.max_strain);
  summary.worst_penetration = std::max(summary.worst_penetration, simulation().surfacePenetration());
  summary.mean_hand_force += state.hand_force;
  summary.finite = isFinite(state);
  // Trapezoidal rule, because the force changes during the step.
  const double speed = (state.inserted_length - last_insertion_) / scene().solver.time_step;
  const double mass = simulatedMass(simulation());
  work_ += 0.5 * (last_force_ + state.hand_force) * (state.inserted_length - last_insertion_) +
           0.5 * (last_torque_ + state.hand_torque) * (state.rotation - last_rotation_);
  // Wire entering the guide has received its kinetic energy outside.
  work_ += 0.5 * (mass - last_mass_) * speed * speed;
  last_mass_ = mass;
  last_insertion_ = state.inserted_length;
  last_rotation_ = state.rotation;
  last_force_ = state.hand_force;
  last_torque_ = state.hand_torque;
}

void BenchRun::checkEnergy(RunSummary& summary)
{
  if (!summary.finite)
    return;
  const rod::Energy elastic = simulation().energy();
  const double energy = elastic.bending + elastic.twist + kineticEnergy(simulation()) - first_energy_;
  summary.largest_energy = std::max(summary.largest_energy, energy);
  summary.energy_excess = std::max(summary.energy_excess, energy - work_);
  if (wall() == nullptr)
    return;
  const rod::State& state = simulation().state();
  for (int i = simulation::firstInsertedNode(simulation()); i < simulation().discretisation().nodes(); ++i)
    summary.nodes_outside += wall()->signedDistance(state.position[i]) < 0.0;
}

std::vector<Eigen::Vector3d> centreline(const simulation::Simulation& simulation, double spacing)
{
  const rod::State& state = simulation.state();
  const rod::Discretisation& wire = simulation.discretisation();
  std::vector<Eigen::Vector3d> points;
  int edge = wire.nodes() - 2;
  for (double back = 0.0; back < state.inserted_length; back += spacing)
  {
    const double at = wire.length() - back;
    while (edge > state.first_node && wire.position[edge] > at)
      --edge;
    const double t = (at - wire.position[edge]) / wire.rest_length[edge];
    points.push_back((1.0 - t) * state.position[edge] + t * state.position[edge + 1]);
  }
  return points;
}

CurveDistance distanceBetween(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b)
{
  CurveDistance distance;
  const std::size_t count = std::min(a.size(), b.size());
  for (std::size_t k = 0; k < count; ++k)
  {
    const double d = (a[k] - b[k]).norm();
    distance.rms += d * d;
    distance.largest = std::max(distance.largest, d);
  }
  distance.rms = count > 0 ? std::sqrt(distance.rms / static_cast<double>(count)) : 0.0;
  return distance;
}

}  // namespace endovascular_sim::benchmark
