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

/** Statistics of a set of durations [s]. */
struct DurationStatistics
{
  double mean = 0.0;
  double median = 0.0;
  double p99 = 0.0;  ///< 99th percentile [s]
  double max = 0.0;
};

/** @param seconds durations in any order [s]; an empty set gives zeros */
DurationStatistics durationStatistics(std::vector<double> seconds);

/** Accumulator of the measurements of an offline run, for result.json. It reads no clock. */
class RunResult
{
public:
  /** @param expected_steps number of steps for which memory is reserved */
  RunResult(const scene::Scene& scene, std::uint64_t mesh_hash, std::size_t expected_steps);

  /** Adds a step; to be called after each step of the simulation.
   *  @param seconds wall time of the step [s] */
  void addStep(const simulation::Simulation& simulation, double seconds);

  /** Updates the largest number of inserted nodes outside the wall. Costs one nearest-triangle search per node that has
   *  moved by as much as its last distance from the wall. */
  void checkOutside(const simulation::Simulation& simulation, const contact::Detector& wall);

  /** Result as JSON (docs/SIMULATE.md).
   *  @param wall_forces wall forces of all steps; null without a vessel */
  std::string json(const simulation::Simulation& simulation, const WallForceMap* wall_forces = nullptr) const;

  /** Adds the outcome of balloons and stents. */
  void setTreatment(const scene::Scene& scene, const simulation::Simulation& simulation,
                    const std::vector<LesionOutcome>& lesions);

  int nodesOutside() const { return nodes_outside_; }
  double worstPenetration() const { return worst_penetration_; }  ///< of a surface beyond the wall [m]
  std::uint64_t rejectedSteps() const { return rejected_steps_; }

private:
  void addHands(const simulation::Simulation& simulation);

  std::string scene_name_;
  std::uint64_t scene_hash_;
  std::uint64_t mesh_hash_;
  double time_step_;
  std::vector<double> step_seconds_;
  std::array<std::vector<double>, kPhaseCount> phase_seconds_;
  double worst_penetration_ = 0.0;
  double worst_penetration_time_ = 0.0;
  int nodes_outside_ = 0;
  /** Last search of the wall for a node. */
  struct Clearance
  {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
    double distance = 0.0;                               ///< to the wall; at most 0: outside or unknown [m]
    int triangle = -1;                                   ///< the nearest; −1: unknown
  };
  std::vector<Clearance> clearances_;  ///< of each node
  std::uint64_t wall_version_ = 0;     ///< of the vessel, for which they hold
  double max_strain_ = 0.0;
  std::uint64_t strained_steps_ = 0;
  RunningValue hand_force_;   ///< in every step, force on the hand with the largest one
  RunningValue hand_torque_;  ///< in every step, torque on the hand with the largest one
  std::vector<std::string> hand_names_;
  std::vector<RunningValue> hand_forces_;   ///< for each instrument
  std::vector<RunningValue> hand_torques_;  ///< for each instrument
  std::array<RunningValue, 7> hand_parts_;  ///< contributions to the rendered force, in the order of kHandParts
  rod::StepReport work_;
  std::uint64_t rejected_steps_ = 0;
  std::string treatment_ = "null";  ///< outcome of balloons and stents as JSON
};

}  // namespace endovascular_sim::results
