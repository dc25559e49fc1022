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

/** What an offline run has besides its simulation: the scripted operator, where the scene has one, and the metrics. */
class SessionRun
{
public:
  /** @param vessel before anything is done to it
   *  @param entry the introducer, patient frame [m]
   *  @throws InputError for a procedure that names a branch which the vessel does not have */
  SessionRun(const scene::Scene& scene, vessel::Vessel vessel, const Eigen::Vector3d& entry);

  /** For the coming step, one per instrument; to be called once before every step. */
  const std::vector<simulation::HandCommand>& commands(const simulation::Simulation& simulation);

  /** Whether the procedure is done or has failed. */
  bool isOver() const { return operator_ && operator_->progress() != procedure::Progress::kRunning; }

  /** After every step. @param contacts of the step */
  void addStep(const simulation::Simulation& simulation, const std::vector<simulation::WallContact>& contacts);

  /** Saves or loads the operator; the metrics count from the loaded state on. */
  void archive(Archive& archive)
  {
    if (operator_)
      operator_->archive(archive);
  }

  SessionMetrics& metrics() { return metrics_; }
  const std::optional<procedure::Operator>& scriptedOperator() const { return operator_; }
  const vessel::Vessel& vessel() const { return vessel_; }

  /** Takes down how it ended. @param wall as it is now; null: it did not move */
  void finish(const simulation::Simulation& simulation, const geometry::TriangleMesh* wall);

  /** Writes metrics.json, metrics.html and instruments.csv.
   *  @throws InputError when the disk refuses them */
  void write(const std::string& folder) const;

private:
  scene::Scene scene_;
  vessel::Vessel vessel_;
  std::optional<procedure::Operator> operator_;
  SessionMetrics metrics_;
  std::vector<simulation::HandCommand> commands_;
};

/** instruments.csv: a row per sample and instrument, SI units. */
std::string instrumentsCsv(const SessionMetrics& metrics);

/** Writes metrics.json, metrics.html and instruments.csv.
 *  @throws InputError when the disk refuses them */
void writeMetrics(const SessionMetrics& metrics, const std::string& folder);

}  // namespace endovascular_sim::results
