#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contact/detector.h"
#include "procedure/operator.h"
#include "results/run_result.h"
#include "results/session_metrics.h"
#include "results/wall_force_map.h"
#include "session/world.h"
#include "simulation/contact_forces.h"
#include "simulation/simulation.h"

namespace endovascular_sim::session
{

/** Files of RunRecord::write(). */
enum class RecordFiles
{
  kMetrics,  ///< metrics.json, metrics.html and instruments.csv
  kAll,      ///< also result.json, scene.yaml, wall_forces.csv and vessel_points.csv
};

/** Results of a run, gathered step by step: statistics of the steps, and with a vessel the wall forces and the training
 *  metrics. */
class RunRecord
{
public:
  /** @param scene of the run: that of the world, or varied
   *  @param expected_steps number of steps for which memory is reserved */
  RunRecord(std::shared_ptr<const World> world, std::shared_ptr<const scene::Scene> scene, std::size_t expected_steps);

  /** Adds a step; to be called after each step.
   *  @param contacts wall contacts of the step
   *  @param seconds computing time of the step [s] */
  void addStep(const simulation::Simulation& simulation, const std::vector<simulation::WallContact>& contacts,
               double seconds);

  /** Looks for nodes outside the wall, as RunResult::checkOutside(). */
  void checkOutside(const simulation::Simulation& simulation, const contact::Detector& wall)
  {
    result_.checkOutside(simulation, wall);
  }

  /** Adds the outcome of the run. Steps are no longer added afterwards.
   *  @param scripted operator; null without one
   *  @param wall present wall; empty without a vessel */
  void finish(const simulation::Simulation& simulation, const procedure::Operator* scripted,
              const geometry::TriangleMesh& wall);

  bool isFinished() const { return !json_.empty(); }

  /** Text of result.json; empty before finish(). */
  const std::string& resultJson() const { return json_; }

  /** Writes files of results into a folder. Those of the vessel and of the metrics need a vessel.
   *  @pre finish() has been called
   *  @throws InputError if a file cannot be written */
  void write(const std::string& folder, RecordFiles files) const;

  const results::RunResult& result() const { return result_; }

  /** Metrics; null without a vessel. */
  const results::SessionMetrics* metrics() const { return metrics_ ? &*metrics_ : nullptr; }

  /** Forces on the wall; null without a vessel. */
  const results::WallForceMap* wallForces() const { return wall_forces_ ? &*wall_forces_ : nullptr; }

private:
  std::shared_ptr<const World> world_;
  std::shared_ptr<const scene::Scene> scene_;
  results::RunResult result_;
  results::SessionSampler sampler_;
  std::optional<results::SessionMetrics> metrics_;
  std::optional<results::WallForceMap> wall_forces_;
  std::string json_;  ///< text of result.json
};

}  // namespace endovascular_sim::session
