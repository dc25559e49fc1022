#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "common/archive.h"
#include "procedure/branch_locator.h"
#include "procedure/observation.h"
#include "procedure/operator_hands.h"
#include "procedure/route.h"
#include "procedure/step_record.h"
#include "scene/model/scene_procedure.h"

namespace endovascular_sim::procedure
{

/** Execution of one step of a procedure: its goal, the motion towards it, retries, and the recovery of a lost support.
 */
class StepExecution
{
public:
  /** What the steps of a procedure have in common. */
  struct Setting
  {
    scene::HandScene hand;
    bool guided = false;  ///< true: a person moves the instruments
    std::shared_ptr<const BranchLocator> branches;
    Eigen::Vector3d entry;  ///< position of the introducer, patient frame [m]
    int entry_branch = -1;  ///< branch that contains it
  };

  explicit StepExecution(Setting setting) : setting_(std::move(setting)) {}

  /** Chooses the step, without beginning it.
   *  @param instrument index of the moved instrument; −1: none
   *  @param support index of the supporting instrument; −1: none
   *  @param losses number of earlier losses of the support in this step */
  void prepare(const scene::StepScene& step, int instrument, int support, int losses);

  /** Begins the step that prepare() chose. */
  void begin(const Observation& observation, OperatorHands& hands);

  /** Sets the target speeds of the hands.
   *  @param retries number of retries of the step, which the function increments
   *  @return state of the step; after kRunning it is to be observed again */
  Progress observe(const Observation& observation, OperatorHands& hands, int& retries);

  /** Reason of Progress::kFailed, with the position of the tip. */
  const std::string& failure() const { return failure_; }

  /** Saves or loads the mutable state, for a step that prepare() chooses. */
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

  const BranchLocator& locator() const { return *setting_.branches; }
  const InstrumentView& active(const Observation& observation) const;
  double holdTime() const;
  bool isReached(const Observation& observation) const;
  bool asksThePatient() const;
  bool isAsked(const Observation& observation) const;
  bool isPatientReady(const Observation& observation) const;
  bool heartRests(const HeartView& heart) const;
  bool isGoalReachedBy(const InstrumentView& view) const;
  bool hasPressure(const InstrumentView& view) const;
  bool hasInjected(const Observation& observation) const;
  Progress inject(const Observation& observation);
  bool isWrongBranch(int branch) const;
  bool isSupportPosition(const InstrumentView& view) const;
  bool hasLostSupport(const Observation& observation);
  bool isStalled(const InstrumentView& view, double time);
  double insertionSpeed(const InstrumentView& view, double speed) const;
  Progress act(const Observation& observation, OperatorHands& hands, int& retries);
  void execute(const InstrumentView& view, OperatorHand& hand) const;
  Progress retry(Mode mode, const InstrumentView& view, double time, const std::string& why, int& retries);
  void recover(const InstrumentView& view, double time, OperatorHand& hand);
  Progress recoverSupport(const Observation& observation, OperatorHand& hand);
  void enter(Mode mode, const InstrumentView& view, double time);
  void noteProgress(const InstrumentView& view, double time);
  Progress fail(const InstrumentView& view, const std::string& why);

  Setting setting_;
  scene::StepScene step_;
  int active_ = -1;             ///< moved instrument; −1: none
  int goal_branch_ = -1;        ///< −1: none
  std::vector<bool> on_way_;    ///< for each branch: true if it lies on the path to the goal
  std::optional<Route> route_;  ///< path to the goal of a steered step
  int support_ = -1;            ///< supporting instrument; −1: none
  int support_branch_ = -1;
  int losses_ = 0;  ///< earlier losses of the support
  Mode mode_ = Mode::kExecute;
  double begin_time_ = 0.0, begin_insertion_ = 0.0, begin_rotation_ = 0.0;
  double begin_injected_ = 0.0;                            ///< volume of contrast medium injected before the step [m³]
  double reached_since_ = -1.0;                            ///< time of reaching the goal; negative: not reached [s]
  double lost_since_ = -1.0;                               ///< time of losing the support; negative: not lost [s]
  double progress_time_ = 0.0, progress_insertion_ = 0.0;  ///< time and insertion at the last progress
  Eigen::Vector3d progress_tip_ = Eigen::Vector3d::Zero();               ///< tip at the last progress [m]
  double mode_insertion_ = 0.0, mode_rotation_ = 0.0, mode_time_ = 0.0;  ///< state at the start of the mode
  std::string failure_;
};

}  // namespace endovascular_sim::procedure
