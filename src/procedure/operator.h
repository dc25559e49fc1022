#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/archive.h"
#include "procedure/branch_entries.h"
#include "procedure/branch_locator.h"
#include "procedure/observation.h"
#include "procedure/route.h"
#include "scene/model/scene.h"
#include "simulation/simulation.h"

namespace endovascular_sim::procedure
{

/** State of a procedure or of one step. */
enum class Progress
{
  kRunning,
  kDone,
  kFailed,
  kSupportLost,  ///< the step lost its support, and the procedure resumes from an earlier step
};

/** Record of one step of the procedure. */
struct StepRecord
{
  std::string name;        ///< description, e.g. "advance wire until its tip is in aortic_arch"
  std::string phase;       ///< phase of the procedure
  std::string view;        ///< view of the C-arm; empty: that of the scene
  double begin = 0.0;      ///< start time [s]
  double end = 0.0;        ///< end time; the latest observation while the step runs [s]
  int retries = 0;         ///< number of retries
  int wrong_branches = 0;  ///< number of entries into wrong branches, see BranchEntries
  Progress outcome = Progress::kRunning;
  std::size_t step = 0;  ///< index of the step in the procedure, an exchange counted as two
  std::string hint;      ///< advice to a person; empty: none
};

/** Scripted operator: a state machine that drives the instruments through the steps of the scene's procedure. In a
 * guided procedure a person drives them: the operator observes which goals are reached, and wrong branches, without a
 * limit of time and without commands.
 *
 *  At its reaction interval it observes the tips and the forces at the handles. It moves one instrument at a time
 *  within the limits of HandScene. Equal observations give equal commands, bit for bit.
 *
 *  If an instrument makes no progress or enters a wrong branch, the operator pulls it back, rotates it and retries. If
 *  an instrument loses its support, the operator withdraws it and resumes from an earlier step. */
class Operator
{
public:
  /** @param scene scene with a procedure
   *  @param tree centreline tree of the vessel
   *  @param entry position of the introducer, patient frame [m]
   *  @throws InputError for an unknown branch, listing the branches of the vessel */
  Operator(const scene::Scene& scene, const vessel::CentrelineTree& tree, const Eigen::Vector3d& entry);

  /** @param branches of the vessel, with the procedure's names; shared by any number of operators */
  Operator(const scene::Scene& scene, std::shared_ptr<const BranchLocator> branches, const Eigen::Vector3d& entry);

  /** Commands for the next step of the simulation, one per instrument. Instruments without drive.source: procedure
   *  follow their own drives. To be called once before each step. */
  const std::vector<simulation::HandCommand>& next(const simulation::Simulation& simulation);

  /** Parts of next(), for observations from another source. @{ */
  bool observesBefore(std::uint64_t step) const { return step % observation_interval_ == 0; }
  void observe(const Observation& observation);
  const std::vector<simulation::HandCommand>& advance(double end_time);
  /** @} */

  Progress progress() const { return progress_; }
  /** Description of the failure: step, reason, position of the tip; empty without a failure. */
  const std::string& failure() const { return failure_; }
  const std::vector<StepRecord>& records() const { return records_; }  ///< records of all steps begun so far
  std::size_t steps() const { return steps_.size(); }                  ///< number of steps, an exchange counted as two
  const BranchLocator& locator() const { return *branches_; }
  int entryBranch() const { return entry_branch_; }  ///< branch that contains the introducer

  /** Saves or loads the mutable state. */
  void archive(Archive& archive);

private:
  /** Activity within a step. */
  enum class Mode
  {
    kExecute,         ///< the action of the step
    kLeaveBranch,     ///< withdrawal from a wrong branch
    kPullBack,        ///< further withdrawal by retry.back
    kRotate,          ///< rotation by retry.turn before the retry
    kRecoverSupport,  ///< withdrawal into the support, before an earlier phase resumes
  };

  struct Hand
  {
    double insertion = 0.0, rotation = 0.0;              ///< commanded position [m], [rad]
    double speed = 0.0, turn_speed = 0.0;                ///< present speeds [m/s], [rad/s]
    double target_speed = 0.0, target_turn_speed = 0.0;  ///< target speeds of the acceleration [m/s], [rad/s]
    double pressure = 0.0;                               ///< commanded pressure [Pa]
    void archive(Archive& archive)
    {
      archive(insertion, rotation, speed, turn_speed, target_speed, target_turn_speed, pressure);
    }
    bool scripted = false;  ///< true if the procedure drives the instrument
  };

  void checkBranches() const;
  void begin(const Observation& observation);
  void prepareStep();
  void archiveRecords(Archive& archive);
  void act(const Observation& observation);
  void execute(const InstrumentView& view);
  void steer(const InstrumentView& view);
  bool isInWrongBranch(const InstrumentView& view) const;
  bool hasPressure(const InstrumentView& view) const;
  double holdTime() const;
  void recover(const InstrumentView& view, double time);
  bool isReached(const Observation& observation) const;
  bool isSupportPosition(const InstrumentView& view) const;
  bool hasLostSupport(const Observation& observation);
  void recoverSupport(const Observation& observation);
  void handleLostSupport(const InstrumentView& view, double time);
  bool isStalled(const InstrumentView& view, double time);
  bool retry(Mode mode, const InstrumentView& view, const std::string& why);
  void fail(const InstrumentView* view, const std::string& why);
  void finishStep(double time);
  void stop();
  double insertionSpeed(const InstrumentView& view, double speed) const;
  const scene::StepScene& step() const { return steps_[current_]; }
  std::string nameOf(const scene::StepScene& step) const;
  std::string viewOf(std::size_t step) const;

  scene::Scene scene_;
  scene::HandScene hand_;
  std::shared_ptr<const BranchLocator> branches_;
  Eigen::Vector3d entry_;  ///< position of the introducer [m]
  int entry_branch_ = -1;
  std::uint64_t observation_interval_ = 1;
  std::vector<scene::StepScene> steps_;  ///< steps of the procedure, with each exchange split into two
  BranchEntries entries_;
  std::vector<Hand> hands_;
  std::vector<simulation::HandCommand> commands_;
  std::vector<StepRecord> records_;
  std::size_t current_ = 0;
  bool begun_ = false;
  Progress progress_ = Progress::kRunning;
  std::string failure_;

  // State of the current step:
  int active_ = -1;  ///< moved instrument; −1: none
  int goal_branch_ = -1;
  std::vector<bool> on_way_;    ///< for each branch: true if it lies on the path to the goal
  std::optional<Route> route_;  ///< path to the goal of a steered step
  int support_ = -1;            ///< supporting instrument; −1: none
  int support_branch_ = -1;
  Mode mode_ = Mode::kExecute;
  double begin_time_ = 0.0, begin_insertion_ = 0.0, begin_rotation_ = 0.0;
  double reached_since_ = -1.0;                             ///< time of reaching the goal; negative: not reached [s]
  double lost_since_ = -1.0;                                ///< time of losing the support; negative: not lost [s]
  double progress_time_ = 0.0, progress_insertion_ = 0.0;   ///< time and insertion at the last progress
  Eigen::Vector3d progress_tip_ = Eigen::Vector3d::Zero();  ///< tip at the last progress [m]
  double mode_insertion_ = 0.0, mode_rotation_ = 0.0, mode_time_ = 0.0;  ///< state at the start of the mode
};

}  // namespace endovascular_sim::procedure
