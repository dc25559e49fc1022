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
#include "procedure/operator_hands.h"
#include "procedure/step_execution.h"
#include "procedure/step_record.h"
#include "scene/model/scene.h"
#include "simulation/simulation.h"

namespace endovascular_sim::procedure
{

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
  const std::vector<drive::HandCommand>& next(const simulation::Simulation& simulation);

  /** Parts of next(), for observations from another source. @{ */
  bool observesBefore(std::uint64_t step) const { return step % observation_interval_ == 0; }
  void observe(const Observation& observation);
  const std::vector<drive::HandCommand>& advance(double end_time) { return hands_.advance(scene_, end_time); }
  /** @} */

  /** Commands of the last call of next() or advance(). */
  const std::vector<drive::HandCommand>& commands() const { return hands_.commands(); }

  /** Hyperaemia that the scripted operator sets in the present step. Empty: the step has no such value, or a person
   * does the steps. */
  std::optional<bool> wantedHyperaemia() const;

  /** Breath-hold that the scripted operator sets in the present step, in the same way. */
  std::optional<bool> wantedBreathHold() const;

  /** Injection of contrast medium that the scripted operator begins before the present step; once, then empty. */
  std::optional<contrast::Injection> takeInjection();

  Progress progress() const { return progress_; }
  /** Description of the failure: step, reason, position of the tip; empty without a failure. */
  const std::string& failure() const { return failure_; }
  const std::vector<StepRecord>& records() const { return records_; }  ///< records of all steps begun so far
  std::size_t steps() const { return steps_.size(); }                  ///< number of steps, an exchange counted as two
  const BranchLocator& locator() const { return *branches_; }

  /** Saves or loads the mutable state. */
  void archive(Archive& archive);

private:
  void checkBranches() const;
  void begin(const Observation& observation);
  void prepareStep();
  void repeatSupport();
  void fail();
  void archiveRecords(Archive& archive);
  const scene::StepScene& step() const { return steps_[current_]; }
  bool asksThePatient() const;
  void describe(StepRecord& record, const StepRecord* before) const;
  std::string viewOf(std::size_t step) const;

  scene::Scene scene_;
  std::shared_ptr<const BranchLocator> branches_;
  int entry_branch_ = -1;
  std::uint64_t observation_interval_ = 1;
  std::vector<scene::StepScene> steps_;  ///< steps of the procedure, with each exchange split into two
  BranchEntries entries_;
  OperatorHands hands_;
  std::vector<StepRecord> records_;
  std::size_t current_ = 0;  ///< index of the current step
  bool begun_ = false;       ///< true while the current step runs
  StepExecution execution_;  ///< of the current step
  Progress progress_ = Progress::kRunning;
  std::string failure_;
  bool injects_ = false;  ///< the injection of the step is to begin
};

}  // namespace endovascular_sim::procedure
