#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include <diagnostic_msgs/DiagnosticArray.h>

#include "endovascular_sim/ContactForceMap.h"
#include "endovascular_sim/DriveApplied.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/SessionGap.h"
#include "endovascular_sim/SessionMark.h"
#include "endovascular_sim/VesselMesh.h"
#include "nodes/session/metrics_recorder.h"
#include "results/report.h"
#include "results/trajectory_csv.h"
#include "scene/model/scene.h"

namespace endovascular_sim::nodes
{

/** Identity of a session of this program. */
results::SessionIdentity identityOf(const scene::Scene& scene);

/** Results of a session from the messages of the graph: trajectory.csv during the session, then report.json, the tables
 *  of the wall forces and the metrics. */
class SessionResults
{
public:
  /** @param folder existing folder of all results
   *  @param steps number of steps of the session; wall forces and metrics of later steps are ignored
   *  @throws InputError when a file cannot be written */
  SessionResults(const scene::Scene& scene, std::string folder, std::uint64_t steps);

  /** Results of an earlier session. @param identity of the program that recorded it */
  SessionResults(const scene::Scene& scene, results::SessionIdentity identity, std::string folder, std::uint64_t steps);

  void add(const DriveApplied& drive);
  void add(const RodStateVisual& rod);
  void add(const ContactForceMapConstPtr& map);
  /** @param vessel initial vessel */
  void add(const VesselMeshConstPtr& vessel);
  void add(const VesselCentreline& centreline);
  void add(const diagnostic_msgs::DiagnosticArray& diagnostics);
  void add(const SessionMark& mark);
  void add(const SessionGap& gap);

  MetricsRecorder& metrics() { return metrics_; }
  results::SessionReport& report() { return report_; }
  const results::SessionReport& report() const { return report_; }
  /** Reason for which trajectory.csv is incomplete; empty without one. */
  const std::string& trajectoryError() const { return trajectory_.error(); }
  /** True when the wall forces of all steps have arrived, or the scene has no vessel. */
  bool hasFinalMap() const;

  /** Writes all files; every failure is logged.
   *  @param error reason of an early end; empty: none
   *  @return true when everything was written */
  bool write(const results::RecordingOutcome& recording, const std::string& error);
  std::string verdict() const { return metrics_.verdict(); }  ///< on a lesson, after write(); empty without pass marks

private:
  void writeWallForces() const;
  std::string path(const std::string& name) const { return folder_ + "/" + name; }

  std::string folder_;
  std::uint64_t steps_;
  bool has_vessel_;
  results::SessionReport report_;
  results::TrajectoryFile trajectory_;
  MetricsRecorder metrics_;
  ContactForceMapConstPtr force_map_;  ///< newest map
  VesselMeshConstPtr vessel_;          ///< initial vessel
};

}  // namespace endovascular_sim::nodes
