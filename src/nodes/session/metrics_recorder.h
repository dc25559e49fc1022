#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "endovascular_sim/DriveApplied.h"
#include "endovascular_sim/HeartPhase.h"
#include "endovascular_sim/ProcedureStep.h"
#include "endovascular_sim/SessionSample.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "endovascular_sim/WallDisplacement.h"
#include "results/lesson_mark.h"
#include "results/session_metrics.h"
#include "scene/model/scene.h"

namespace endovascular_sim::nodes
{

/** Metrics of a session from the messages of the graph, live or recorded. They equal those of `simulate` for the same
 *  trajectory. */
class MetricsRecorder
{
public:
  /** @param steps number of steps of the session; messages of later steps are ignored */
  explicit MetricsRecorder(scene::Scene scene, std::uint64_t steps = std::numeric_limits<std::uint64_t>::max())
    : scene_(std::move(scene)), steps_(steps)
  {
  }

  void add(const VesselMesh& mesh);
  void add(const VesselCentreline& centreline);
  /** @throws InputError when a list does not match the instruments of the scene */
  void add(const SessionSample& sample);
  void add(const ProcedureStep& step);
  /** Adds the mean pressures of the last beat. */
  void add(const HeartPhase& heart);
  /** Adds the forces on the hands in a step without a fault. Those after the last sample belong to the metrics too. */
  void add(const DriveApplied& drive);
  /** Displacements before the vessel are ignored.
   *  @throws InputError for an invalid displacement */
  void add(const WallDisplacement& moved);
  /** @throws InputError when lists of the message differ in length, or an event names no instrument of the scene */
  void add(const TreatmentVisual& treatment);

  /** Evaluates the lesions and writes metrics.json, metrics.html and instruments.csv; without a vessel it does nothing.
   *  @throws InputError when a file cannot be written */
  void write(const std::string& folder, const results::WallForceSummary* forces,
             const results::RecordingNotes& notes = {});

  /** Permits that steps of the procedure began in a gap of the recording; each has a row without values. */
  void allowMissingSteps() { may_lack_steps_ = true; }

  /** Errors of the trainee so far, in the order of their times; before write() only. */
  std::vector<results::SessionError> errors() const;

  /** Entries into wrong branches so far: time [s] and text, e.g. "wire in diagonal_1"; before write() only. */
  std::vector<std::pair<double, std::string>> wrongBranches() const;

  /** Marks of a lesson, after write(); empty without pass marks. */
  std::vector<results::Mark> marks() const;

  /** Verdict on a lesson, after write(); empty without pass marks. */
  std::string verdict() const;

private:
  /** Event of a balloon or stent. */
  struct Event
  {
    std::string kind;
    int instrument = 0;
    double time = 0.0;  ///< [s]
  };

  void begin();
  void followRisk(const WallDisplacement& moved);
  int firstBalloon() const;

  scene::Scene scene_;
  std::uint64_t steps_;
  vessel::Vessel vessel_;                                 ///< initial vessel
  geometry::TriangleMesh wall_;                           ///< current wall
  std::vector<intervention::RoundBody> stents_;           ///< opened stents
  std::vector<Event> events_;                             ///< events of balloons and stents, without those of the wall
  std::vector<Event> risks_;                              ///< events of the wall
  bool at_risk_ = false;                                  ///< risk of the wall at its newest displacement
  std::unique_ptr<results::SessionMetrics> metrics_;      ///< null before the vessel
  std::vector<results::Sample> early_samples_;            ///< samples before the vessel
  std::vector<flow::BeatMeans> early_beats_;              ///< beats before the vessel
  std::uint64_t sampled_steps_ = 0;                       ///< number of steps up to the newest sample
  std::map<std::uint64_t, results::Peaks> since_sample_;  ///< for each step since then: forces on the hands
  std::vector<procedure::StepRecord> procedure_steps_;
  std::string failure_;
  bool may_lack_steps_ = false;  ///< true after a gap of the recording
};

}  // namespace endovascular_sim::nodes
