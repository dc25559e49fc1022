#include "results/run_result.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <nlohmann/json.hpp>

#include "results/contrast_use.h"
#include "results/session_sample.h"
#include "results/wall_force_report.h"
#include "simulation/instrument_tip.h"

namespace endovascular_sim::results
{
namespace
{

using Json = nlohmann::ordered_json;

constexpr double kCountedStrain = 1e-4;  // strain above which a step is counted, e.g. a snap-through over a ridge [1]

constexpr std::size_t kReservedSteps = 1U << 20U;  // largest number of steps for which memory is reserved

struct HandPart
{
  const char* name;
  double rod::HandForceParts::*value;
};
constexpr double kSafeShare = 0.999;  // of a distance from the wall within which a node stays inside [1]
constexpr double kSlowStep = 300e-6;  // step time above which a step is counted as slow [s]
constexpr std::array<HandPart, 7> kHandParts = {{{"bending", &rod::HandForceParts::bending},
                                                 {"friction", &rod::HandForceParts::friction},
                                                 {"inertia", &rod::HandForceParts::inertia},
                                                 {"drag", &rod::HandForceParts::drag},
                                                 {"load", &rod::HandForceParts::load},
                                                 {"valve", &rod::HandForceParts::valve},
                                                 {"configurational", &rod::HandForceParts::configurational}}};

/** Statistics of a quantity; null without samples. */
Json toJson(const RunningValue& value)
{
  if (value.count() == 0)
    return nullptr;
  return {{"max", value.max()}, {"mean", value.mean()}, {"final", value.final()}};
}

Json toJson(const DurationStatistics& statistics)
{
  const double to_us = 1e6;
  return {{"mean", to_us * statistics.mean},
          {"median", to_us * statistics.median},
          {"p99", to_us * statistics.p99},
          {"max", to_us * statistics.max}};
}

Json toJson(const Eigen::Vector3d& v)
{
  return {v.x(), v.y(), v.z()};
}

}  // namespace

DurationStatistics durationStatistics(std::vector<double> seconds)
{
  DurationStatistics statistics;
  if (seconds.empty())
    return statistics;
  std::sort(seconds.begin(), seconds.end());
  const std::size_t n = seconds.size();
  statistics.mean = std::accumulate(seconds.begin(), seconds.end(), 0.0) / static_cast<double>(n);
  statistics.median = seconds[n / 2];
  statistics.p99 = seconds[std::min(n - 1, n * 99 / 100)];
  statistics.max = seconds.back();
  return statistics;
}

RunResult::RunResult(const scene::Scene& scene, std::uint64_t mesh_hash, std::size_t expected_steps)
  : scene_name_(scene.name), scene_hash_(scene.hash()), mesh_hash_(mesh_hash), time_step_(scene.solver.time_step)
{
  const std::size_t reserved = std::min(expected_steps, kReservedSteps);
  step_seconds_.reserve(reserved);
  for (std::vector<double>& phase : phase_seconds_)
    phase.reserve(reserved);
  for (const scene::DrivenInstrument& driven : scene.instruments)
    hand_names_.push_back(driven.instrument.name);
  hand_forces_.resize(hand_names_.size());
  hand_torques_.resize(hand_names_.size());
}

void RunResult::addStep(const simulation::Simulation& simulation, double seconds)
{
  step_seconds_.push_back(seconds);
  for (std::size_t phase = 0; phase < kPhaseCount; ++phase)
    phase_seconds_[phase].push_back(simulation.timer().seconds(static_cast<Phase>(phase)));
  const double penetration = simulation.surfacePenetration();
  if (penetration > worst_penetration_)
  {
    worst_penetration_ = penetration;
    worst_penetration_time_ = simulation.time();
  }
  max_strain_ = std::max(max_strain_, simulation.report().max_strain);
  strained_steps_ += simulation.report().max_strain > kCountedStrain;
  addHands(simulation);
  for (std::size_t k = 0; k < kHandParts.size(); ++k)
    hand_parts_[k].add(simulation.state().hand_parts.*kHandParts[k].value);
  work_.add(simulation.report());
  rejected_steps_ += !simulation.report().solved;
}

/** Adds force and torque of every hand, as results::Peaks without the steps with a fault. */
void RunResult::addHands(const simulation::Simulation& simulation)
{
  if (faultsOf(simulation.report()).any())
    return;
  double force = 0.0;
  double torque = 0.0;
  for (std::size_t k = 0; k < hand_names_.size(); ++k)
  {
    const simulation::HandState hand = simulation.hand(static_cast<int>(k));
    hand_forces_[k].add(hand.force);
    hand_torques_[k].add(hand.torque);
    force = std::abs(hand.force) > std::abs(force) ? hand.force : force;
    torque = std::abs(hand.torque) > std::abs(torque) ? hand.torque : torque;
  }
  hand_force_.add(force);
  hand_torque_.add(torque);
}

void RunResult::checkOutside(const simulation::Simulation& simulation, const contact::Detector& wall)
{
  int outside = 0;
  const std::vector<Eigen::Vector3d>& positions = simulation.positionsAtRest();
  clearances_.resize(positions.size());
  if (wall_version_ != wall.vesselVersion())
    for (Clearance& clearance : clearances_)
      clearance.distance = 0.0;
  wall_version_ = wall.vesselVersion();
  for (int i = simulation::firstInsertedNode(simulation); i < simulation.discretisation().nodes(); ++i)
  {
    const Eigen::Vector3d& position = positions[i];
    Clearance& clearance = clearances_[i];
    // The distance from the wall is 1-Lipschitz.
    if ((position - clearance.position).norm() < kSafeShare * clearance.distance)
      continue;
    clearance.position = position;
    clearance.distance = wall.signedDistance(position, clearance.triangle, &clearance.triangle);
    outside += clearance.distance < 0.0;
  }
  nodes_outside_ = std::max(nodes_outside_, outside);
}

void RunResult::setTreatment(const scene::Scene& scene, const simulation::Simulation& simulation,
                             const std::vector<LesionOutcome>& lesions)
{
  treatment_ = toJson(scene, simulation, lesions).dump();
}

std::string RunResult::json(const simulation::Simulation& simulation, const WallForceMap* wall_forces) const
{
  const rod::State& state = simulation.state();
  const std::size_t n = state.position.size();
  const DurationStatistics whole = durationStatistics(step_seconds_);
  const rod::Energy energy = simulation.energy();
  Json timing = toJson(whole);
  timing["over_300"] =
      std::count_if(step_seconds_.begin(), step_seconds_.end(), [](double s) { return s > kSlowStep; });
  for (std::size_t phase = 0; phase < kPhaseCount; ++phase)
    timing[kPhaseNames[phase]] = toJson(durationStatistics(phase_seconds_[phase]));
  Json hand_parts;
  for (std::size_t k = 0; k < kHandParts.size(); ++k)
    hand_parts[kHandParts[k].name] = toJson(hand_parts_[k]);
  Json hands = Json::array();
  for (std::size_t k = 0; k < hand_names_.size(); ++k)
    hands.push_back(
        {{"name", hand_names_[k]}, {"force", toJson(hand_forces_[k])}, {"torque", toJson(hand_torques_[k])}});
  Json json = {
      {"scene", scene_name_},
      {"steps", simulation.steps()},
      {"dt", time_step_},
      {"nodes", simulation.discretisation().nodes()},
      {"real_time_factor", whole.mean > 0.0 ? time_step_ / whole.mean : 0.0},
      {"step_time_us", timing},
      {"worst_surface_penetration", worst_penetration_},
      {"worst_surface_penetration_time", worst_penetration_time_},
      {"nodes_outside", nodes_outside_},
      {"max_strain", max_strain_},
      {"steps_with_strain_above_1e-4", strained_steps_},
      {"inserted_length", state.inserted_length},
      {"rotation", state.rotation},
      {"tip_position", toJson(state.position[n - 1])},
      {"tip_tangent", toJson((state.position[n - 1] - state.position[n - 2]).normalized())},
      {"hand_force", {{"max", hand_force_.max()}, {"mean", hand_force_.mean()}, {"final", hand_force_.final()}}},
      {"hands", hands},
      {"hand_force_parts", hand_parts},
      {"hand_torque", {{"max", hand_torque_.max()}, {"mean", hand_torque_.mean()}, {"final", hand_torque_.final()}}},
      {"proximal_force", toJson(state.proximal_force)},
      {"distal_force", toJson(state.distal_force)},
      {"distal_torque", state.distal_torque},
      {"wall_forces", wall_forces ? toJson(wall_forces->summary(), wall_forces->touched().size()) : Json(nullptr)},
      {"treatment", Json::parse(treatment_)},
      {"energy", {{"bending", energy.bending}, {"twist", energy.twist}, {"stretch", energy.stretch}}},
      {"solver",
       {{"solves", work_.solves},
        {"factorisations", work_.factorisations},
        {"truncations", work_.truncations},
        {"halvings", work_.bisections},
        {"steps_at_solve_limit", work_.hit_iteration_limit},
        {"refused_steps", rejected_steps_}}},
      {"trajectory_hash", Hash64::toHex(simulation.trajectoryHash())},
      {"scene_hash", Hash64::toHex(scene_hash_)},
      {"mesh_hash", Hash64::toHex(mesh_hash_)}};
  if (simulation.contrast() != nullptr)
    json["contrast"] = toJson(contrastUseOf(simulation));
  return json.dump(2) + "\n";
}

}  // namespace endovascular_sim::results
