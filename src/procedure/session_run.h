#pragma once

#include <optional>
#include <string>
#include <vector>

#include "procedure/operator.h"
#include "procedure/session_metrics.h"
#include "session/contact_forces.h"
#include "session/simulation.h"
#include "vessel/vessel.h"

namespace endovascular_sim::procedure
{

/** What an offline run has besides its simulation: the scripted operator, where the scene has one, and the metrics. */
class SessionRun
{
public:
  /** @param vessel before anything is done to it
   *  @param entry the introducer, patient frame [m]
   *  @throws InputError for a procedure that names a branch which the vessel does not have */
  SessionRun(const session::Scene& scene, vessel::Vessel vessel, const Eigen::Vector3d& entry);

  /** For the coming step, one per instrument; to be called once before every step. */
  const std::vector<session::HandCommand>& commands(const session::Simulation& simulation);

  /** Whether the procedure is done or has failed. */
  bool isOver() const { return operator_ && operator_->progress() != Progress::kRunning; }

  /** After every step. @param contacts of the step */
  void addStep(const session::Simulation& simulation, const std::vector<session::WallContact>& contacts);

  /** Saves or loads the operator; the metrics count from the loaded state on. */
  void archive(Archive& archive)
  {
    if (operator_)
      operator_->archive(archive);
  }

  SessionMetrics& metrics() { return metrics_; }
  const std::optional<Operator>& person() const { return operator_; }
  const vessel::Vessel& vessel() const { return vessel_; }

  /** Takes down how it ended. @param wall as it is now; null: it did not move */
  void finish(const session::Simulation& simulation, const vessel::TriangleMesh* wall);

  /** Writes metrics.json, metrics.html and instruments.csv.
   *  @throws InputError when the disk refuses them */
  void write(const std::string& folder) const;

private:
  session::Scene scene_;
  vessel::Vessel vessel_;
  std::optional<Operator> operator_;
  SessionMetrics metrics_;
  std::vector<session::HandCommand> commands_;
};

/** instruments.csv: a row per sample and instrument, SI units. */
std::string instrumentsCsv(const SessionMetrics& metrics);

/** Writes metrics.json, metrics.html and instruments.csv.
 *  @throws InputError when the disk refuses them */
void writeMetrics(const SessionMetrics& metrics, const std::string& folder);

}  // namespace endovascular_sim::procedure
