#pragma once

#include <array>
#include <string>
#include <vector>

#include "contact/detector.h"
#include "results/report.h"
#include "results/treatment_report.h"
#include "results/wall_force_map.h"
#include "simulation/simulation.h"

namespace endovascular_sim::results
{

/** Mean, median, 99th percentile and largest of a set of durations. */
struct DurationStatistics
{
  double mean = 0.0;
  double median = 0.0;
  double p99 = 0.0;
  double max = 0.0;
};

/** @param seconds any order; empty gives zeros */
DurationStatistics durationStatistics(std::vector<double> seconds);

/** Collects what an offline run measures, for result.json. Knows no clock: durations are given to it. */
class RunResult
{
public:
  /** @param expected_steps reserves memory */
  RunResult(const scene::Scene& scene, std::uint64_t mesh_hash, std::size_t expected_steps);

  /** After every step of the simulation.
   *  @param seconds wall time of the step */
  void addStep(const simulation::Simulation& simulation, double seconds);

  /** Counts the nodes beyond the introducer that are outside the wall; costs a search per node. */
  void checkOutside(const simulation::Simulation& simulation, const contact::Detector& wall);

  /** The result as JSON (docs/SIMULATE.md).
   *  @param wall_forces of all steps; null without a vessel */
  std::string json(simulation::Simulation& simulation, const WallForceMap* wall_forces = nullptr) const;

  /** Adds what balloons and stents did. */
  void setTreatment(const scene::Scene& scene, const simulation::Simulation& simulation,
                    const std::vector<LesionOutcome>& lesions);

  int nodesOutside() const { return nodes_outside_; }
  std::uint64_t refusedSteps() const { return refused_; }

private:
  std::string scene_name_;
  std::uint64_t scene_hash_;
  std::uint64_t mesh_hash_;
  double time_step_;
  std::vector<double> step_seconds_;
  std::array<std::vector<double>, kPhaseCount> phase_seconds_;
  double worst_penetration_ = 0.0;
  double worst_penetration_time_ = 0.0;
  int nodes_outside_ = 0;
  std::vector<int> nearest_;  ///< triangle that was nearest to each node, or −1
  double max_strain_ = 0.0;
  std::uint64_t strained_steps_ = 0;
  RunningValue hand_force_;
  RunningValue hand_torque_;
  std::array<RunningValue, 6> hand_parts_;  ///< as kHandParts
  rod::StepReport work_;
  std::uint64_t refused_ = 0;
  std::string treatment_ = "null";  ///< JSON
};

/** Nodes beyond the introducer's plane. */
int firstInsertedNode(const simulation::Simulation& simulation);

}  // namespace endovascular_sim::results
