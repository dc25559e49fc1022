#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include "procedure/branch_entries.h"
#include "procedure/branch_locator.h"
#include "procedure/operator.h"
#include "procedure/support_watch.h"
#include "results/contrast_use.h"
#include "results/pressure_course.h"
#include "results/recording_notes.h"
#include "results/session_sample.h"
#include "results/treatment_report.h"
#include "results/wall_force_map.h"
#include "scene/model/scene.h"
#include "vessel/centreline/centreline.h"

namespace endovascular_sim::results
{

/** Stay of an instrument's tip in a wrong branch, as procedure::BranchEntries defines it, at the rate of the samples.
 */
struct WrongBranch
{
  int instrument = 0;    ///< index of the instrument in the scene
  int branch = -1;       ///< index of the branch
  double begin = 0.0;    ///< start of the stay [s]
  double end = 0.0;      ///< end of the stay [s]
  double deepest = 0.0;  ///< largest depth beyond the ostium of the branch [m]
};

/** Error of the trainee or adverse event in a session. */
struct SessionError
{
  std::string kind;    ///< description, e.g. "balloon ahead of its wire"
  int instrument = 0;  ///< index of the instrument in the scene
  double time = 0.0;   ///< start of the error [s]
  double value = 0.0;  ///< magnitude in the unit
  std::string unit;    ///< unit of the value; empty: no value
};

/** Reports whether an event of a treatment is an error: all kinds except a placed stent. */
bool isError(const std::string& event);

/** Period with a fault of the simulator. Errors of the trainee that follow from forces are not counted during and
 *  shortly after it. */
struct SimulatorFault
{
  std::string kind;         ///< "rejected step", "stale contact set" or "non-finite value"
  double begin = 0.0;       ///< start of the period [s]
  double end = 0.0;         ///< end of the period [s]
  std::uint64_t steps = 0;  ///< number of steps with the fault; of samples for non-finite values
};

/** Training metrics of a session; docs/PROCEDURES.md defines them.
 *
 *  The class depends on no clock, no messages and no simulation. The offline tool and the session node supply the same
 *  observations. */
class SessionMetrics
{
public:
  static constexpr double kRate = SessionSampler::kRate;  ///< sampling rate [Hz]

  /** @param entry position of the introducer, patient frame [m] */
  SessionMetrics(const scene::Scene& scene, const vessel::CentrelineTree& tree, const Eigen::Vector3d& entry);

  /** Adds a sample and locates its tips. Only the first sample of a sampling interval is used. */
  void add(Sample sample);

  /** Merges the hands' forces and torques of the steps after the last sample into it. Steps after the end of the
   *  procedure do not count.
   *  @pre the records of the operator are set */
  void addTail(const Peaks& peaks);

  /** Sets the records of the scripted operator. */
  void setSteps(std::vector<procedure::StepRecord> steps, std::string failure);
  void setWallForces(WallForceSummary forces) { wall_forces_ = std::move(forces); }
  const std::optional<WallForceSummary>& wallForces() const { return wall_forces_; }
  const std::vector<LesionOutcome>& lesions() const { return lesions_; }
  void setLesions(std::vector<LesionOutcome> lesions) { lesions_ = std::move(lesions); }
  /** Sets the contrast medium of the session up to now; without this call there was none. */
  void setContrast(const ContrastUse& use) { contrast_ = use; }
  /** Sets what the recording holds beside the motion: remarks of a teacher, and steps that are missing in it. */
  void setNotes(RecordingNotes notes) { notes_ = std::move(notes); }
  /** Adds the mean pressures of a beat; those of the newest one change nothing. @pre the scene has the key `flow` */
  void addBeat(const flow::BeatMeans& means);
  /** Pressures up to the last sample. */
  PressureCourse pressure() const;
  /** Adds an event of a treatment if it is an error. */
  void addEvent(const std::string& kind, int instrument, double time);

  /** Metrics as JSON in SI units. */
  nlohmann::ordered_json json() const;

  const scene::Scene& scene() const { return scene_; }
  const procedure::BranchLocator& locator() const { return locator_; }
  const std::vector<Sample>& samples() const { return samples_; }
  const std::vector<procedure::StepRecord>& steps() const { return steps_; }
  /** Stays in wrong branches; requires the records of the operator. Computed in every call. */
  std::vector<WrongBranch> wrongBranches() const;
  /** Largest axial force on the hand of an instrument, by magnitude, in all steps without a fault [N]. */
  double peakHandForce(std::size_t instrument) const;
  const std::vector<SessionError>& errors() const { return errors_; }
  const std::vector<SimulatorFault>& faults() const { return faults_; }

private:
  void followFaults(const Sample& sample);
  void addFault(const char* kind, double time, std::uint64_t steps);
  void followWires(const Sample& sample);
  void followExchanges(const Sample& sample);
  void followForces(const Sample& sample);
  void followPerforation(const Sample& sample, int foremost);
  void followTipForce(const Sample& sample, int foremost);
  void followSupport(const Sample& sample);
  int stepAt(double time) const;
  nlohmann::ordered_json stepsJson(const std::vector<WrongBranch>& stays) const;
  nlohmann::ordered_json instrumentJson(std::size_t k, const std::vector<WrongBranch>& stays) const;
  nlohmann::ordered_json errorsJson() const;
  nlohmann::ordered_json faultsJson() const;
  double activeTime() const;
  const std::string& nameOf(int instrument) const;

  scene::Scene scene_;
  procedure::BranchLocator locator_;
  procedure::BranchEntries branch_entries_;  ///< before the first sample
  scene::ErrorLimits limits_;
  procedure::SupportWatch support_watch_;
  std::vector<Sample> samples_;
  std::int64_t interval_ = -1;  ///< sampling interval of the newest sample
  double sampled_until_ = 0.0;  ///< time of the newest sample, a rejected one included [s]
  std::vector<SimulatorFault> faults_;
  double untrusted_until_ = 0.0;  ///< time until which forces do not count as those of the trainee [s]
  std::vector<procedure::StepRecord> steps_;
  std::string failure_;
  std::optional<WallForceSummary> wall_forces_;
  std::vector<LesionOutcome> lesions_;
  PressureCourse pressure_;
  std::optional<ContrastUse> contrast_;
  std::vector<SessionError> errors_;
  RecordingNotes notes_;
  std::vector<bool> ahead_;            ///< for each instrument: true if its tip is ahead of all guidewires
  std::vector<double> ahead_time_;     ///< for each instrument: time ahead of all guidewires [s]
  std::size_t perforation_error_ = 0;  ///< index of the latest perforation risk in errors_
  double perforation_until_ = -1e9;    ///< end of the latest perforation risk [s]
  int pushing_ = -1;                   ///< instrument whose tip exceeds ErrorLimits::tip_force; −1: none
  double pushing_since_ = 0.0;         ///< [s]
  double push_ = 0.0;                  ///< its largest force since then [N]
  std::ptrdiff_t push_error_ = -1;     ///< index of this error in errors_; −1: not yet one
  std::vector<bool> was_in_;           ///< for each instrument: true if it was in the introducer at the last sample
  std::vector<int> entries_;           ///< for each instrument: number of insertions into the introducer
  int withdrawn_ = 0;                  ///< withdrawals not yet followed by an insertion
  int exchanges_ = 0;                  ///< number of exchanges
};

}  // namespace endovascular_sim::results
