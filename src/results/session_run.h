#pragma once

#include <optional>
#include <string>
#include <vector>

#include "procedure/operator.h"
#include "results/session_metrics.h"
#include "simulation/contact_forces.h"
#include "simulation/simulation.h"
#include "vessel/model/vessel.h"

namespace endovascular_sim::results
{

/** Scripted operator and metrics of an offline run. */
class SessionRun
{
public:
  /** @param vessel vessel before any treatment
   *  @param entry position of the introducer, patient frame [m]
   *  @throws InputError for an unknown branch in the procedure */
  SessionRun(const scene::Scene& scene, vessel::Vessel vessel, const Eigen::Vector3d& entry);

  /** Commands for the next step, one per instrument; to be called once before each step. */
  const std::vector<simulation::HandCommand>& commands(const simulation::Simulation& simulation);

  /** True if the procedure is complete or has failed. */
  bool isFinished() const { return operator_ && operator_->progress() != procedure::Progress::kRunning; }

  /** Adds a step to the metrics; to be called after each step.
   *  @param contacts wall contacts of the step */
  void addStep(const simulation::Simulation& simulation, const std::vector<simulation::WallContact>& contacts);

  /** Saves or loads the operator. The metrics restart at the loaded state. */
  void archive(Archive& archive)
  {
    if (operator_)
      operator_->archive(archive);
  }

  SessionMetrics& metrics() { return metrics_; }
  const std::optional<procedure::Operator>& scriptedOperator() const { return operator_; }
  const vessel::Vessel& vessel() const { return vessel_; }

  /** Adds the outcome to the metrics.
   *  @param wall present wall; null if it was not deformed */
  void finish(const simulation::Simulation& simulation, const geometry::TriangleMesh* wall);

  /** Writes metrics.json, metrics.html and instruments.csv.
   *  @throws InputError if a file cannot be written */
  void write(const std::string& folder) const;

private:
  scene::Scene scene_;
  vessel::Vessel vessel_;
  std::optional<procedure::Operator> operator_;
  SessionSampler sampler_;
  SessionMetrics metrics_;
  std::vector<simulation::HandCommand> commands_;
};

/** Text of instruments.csv: one row per sample and instrument, SI units. */
std::string instrumentsCsv(const SessionMetrics& metrics);

/** Writes metrics.json, metrics.html and instruments.csv.
 *  @throws InputError if a file cannot be written */
void writeMetrics(const SessionMetrics& metrics, const std::string& folder);

}  // namespace endovascular_sim::results
