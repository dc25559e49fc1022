#include "procedure/step_execution.h"

#include <algorithm>
#include <cmath>

#include "common/text/format.h"
#include "procedure/branch_entries.h"
#include "procedure/tip_steering.h"

namespace endovascular_sim::procedure
{
namespace
{

constexpr double kPressureShare = 0.9;         // share of the pressure that a person has to reach
constexpr double kInjectedShare = 1.0 - 1e-9;  // of the volume of an injection, up to rounding
constexpr double kAmbientPressure = 1e4;       // pressure of an empty balloon that a person need not reach [Pa]
constexpr double kSlowdownShare = 0.6;         // share of the force limit from which the operator slows down
constexpr double kProgress = 2e-3;             // displacement of the tip that counts as progress [m]
constexpr double kModeLimit = 8.0;             // time limit of each mode of a recovery [s]
constexpr double kPullBackSpeed = 0.02;        // speed of pulling back [m/s]
constexpr double kFastestTurn = 2.0;           // of a retry [rad/s]
constexpr double kRestBegin = 1.0 / 3.0;       // share of diastole after which the heart rests
constexpr double kRestEnd = 0.75;              // share of diastole before the contraction of the atria
constexpr double kRecoveryDepth = 0.05;  // distance of the tip behind the tip of the support after its withdrawal [m]

using scene::StepAction;

const InstrumentView& at(const Observation& observation, int instrument)
{
  return observation.instruments[static_cast<std::size_t>(instrument)];
}

}  // namespace

void StepExecution::prepare(const scene::StepScene& step, int instrument, int support, int losses)
{
  step_ = step;
  active_ = instrument;
  support_ = support;
  losses_ = losses;
  const std::string& branch = step.until.tip_in.empty() ? step.until.balloon_in : step.until.tip_in;
  goal_branch_ = branch.empty() ? -1 : locator().find(branch);
  on_way_ = locator().pathBetween(setting_.entry_branch, step.any_branch ? -1 : goal_branch_);
  route_.reset();
  if (step.steer && goal_branch_ >= 0 && goal_branch_ != setting_.entry_branch)
    route_.emplace(locator(), setting_.entry_branch, setting_.entry, goal_branch_);
  support_branch_ = locator().find(step.support.tip_in);
}

void StepExecution::begin(const Observation& observation, OperatorHands& hands)
{
  mode_ = Mode::kExecute;
  reached_since_ = lost_since_ = -1.0;
  begin_time_ = progress_time_ = observation.time;
  begin_injected_ = observation.injected_volume;
  if (active_ < 0)
    return;
  const InstrumentView& view = at(observation, active_);
  begin_insertion_ = progress_insertion_ = view.hand.insertion;
  begin_rotation_ = view.hand.rotation;
  progress_tip_ = view.tip;
  // An instrument far outside the introducer starts at the insertion from which the introducer senses it.
  if (view.outside)
    hands[active_].insertion = std::max(hands[active_].insertion, view.hand.insertion);
  if (step_.action == StepAction::kInflate)
    hands[active_].pressure = step_.pressure;
}

Progress StepExecution::observe(const Observation& observation, OperatorHands& hands, int& retries)
{
  const bool reached = mode_ != Mode::kRecoverSupport && isReached(observation);
  if (!reached)
    reached_since_ = -1.0;
  else if (reached_since_ < 0.0)
    reached_since_ = observation.time;
  hands.stop();
  if (reached && observation.time - reached_since_ >= holdTime())
    return Progress::kDone;
  if (reached && mode_ == Mode::kExecute)
    return Progress::kRunning;
  return act(observation, hands, retries);
}

/** Duration for which the goal of the step must hold [s]. */
double StepExecution::holdTime() const
{
  const bool is_of_person = setting_.guided && (step_.action == StepAction::kInflate || asksThePatient());
  return is_of_person ? step_.duration : step_.until.held;
}

/** True if a balloon has the pressure of the step, or more of it; for a pressure that is not positive, or less. */
bool StepExecution::hasPressure(const InstrumentView& view) const
{
  return step_.pressure > 0.0 ? view.hand.pressure >= kPressureShare * step_.pressure
                              : view.hand.pressure <= kPressureShare * step_.pressure + kAmbientPressure;
}

/** True if the volume of the step has been injected since its beginning. */
bool StepExecution::hasInjected(const Observation& observation) const
{
  return observation.injected_volume - begin_injected_ >= kInjectedShare * step_.volume;
}

bool StepExecution::isReached(const Observation& observation) const
{
  if (step_.action == StepAction::kInject)
    return hasInjected(observation);
  if (setting_.guided && step_.action == StepAction::kInflate)
    return hasPressure(at(observation, active_));
  if (setting_.guided && asksThePatient())
    return isAsked(observation);
  if (step_.action == StepAction::kWait || step_.action == StepAction::kInflate)
    return observation.time - begin_time_ >= step_.duration - 1e-9 && isPatientReady(observation);
  return isGoalReachedBy(at(observation, active_));
}

/** True for a wait that asks for hyperaemia or for a breath-hold, or for their end. */
bool StepExecution::asksThePatient() const
{
  return step_.hyperaemia.has_value() || step_.breath_held.has_value();
}

/** True if the patient has been asked for what the wait names. */
bool StepExecution::isAsked(const Observation& observation) const
{
  return (!step_.hyperaemia || observation.hyperaemia == *step_.hyperaemia) &&
         (!step_.breath_held || !observation.patient_moves || observation.breath_asked == *step_.breath_held);
}

/** True if the breath is held, and the heart rests in its diastole, where the wait names them. */
bool StepExecution::isPatientReady(const Observation& observation) const
{
  const bool is_held = !step_.breath_held.value_or(false) || !observation.patient_moves || observation.breath_held;
  return is_held && (!step_.until_diastole || setting_.guided || heartRests(observation.heart));
}

/** True between early filling and the contraction of the atria; and if this rest is too short to react to. */
bool StepExecution::heartRests(const HeartView& heart) const
{
  const double diastole = 1.0 - heart.systole;
  const double begin = heart.systole + kRestBegin * diastole, end = heart.systole + kRestEnd * diastole;
  const bool is_too_short = end - begin < setting_.hand.reaction * heart.rate;
  return heart.rate == 0.0 || is_too_short || (heart.phase >= begin && heart.phase < end);
}

bool StepExecution::isGoalReachedBy(const InstrumentView& view) const
{
  const scene::GoalScene& goal = step_.until;
  const double forward = step_.action == StepAction::kWithdraw ? -1.0 : 1.0;
  if (goal.outside && !view.outside)
    return false;
  if (goal_branch_ >= 0)
  {
    const bool by_tip = !goal.tip_in.empty();
    if (!by_tip && !view.balloon)
      return false;
    const Eigen::Vector3d& point = by_tip ? view.tip : *view.balloon;
    if (locator().at(point).branch != goal_branch_)
      return false;
    if (!std::isnan(goal.beyond) && forward * (locator().depthIn(goal_branch_, point) - goal.beyond) < 0.0)
      return false;
  }
  if (!std::isnan(goal.insertion) && forward * (view.hand.insertion - goal.insertion) < 0.0)
    return false;
  if (!std::isnan(goal.by) && forward * (view.hand.insertion - begin_insertion_) < goal.by)
    return false;
  return std::isnan(goal.turned) || std::abs(view.hand.rotation - begin_rotation_) >= std::abs(goal.turned);
}

Progress StepExecution::act(const Observation& observation, OperatorHands& hands, int& retries)
{
  if (step_.action == StepAction::kInject && !setting_.guided)
    return inject(observation);
  if (active_ < 0 || setting_.guided || step_.action == StepAction::kInflate)
    return Progress::kRunning;
  const InstrumentView& view = at(observation, active_);
  OperatorHand& hand = hands[active_];
  if (observation.time - begin_time_ > step_.time_limit)
    return fail(view, formatted("not done within %.4g s", step_.time_limit));
  if (mode_ == Mode::kRecoverSupport)
    return recoverSupport(observation, hand);
  if (hasLostSupport(observation))
  {
    if (losses_ >= step_.support.times)
      return fail(view, step_.support.instrument + " has left " + step_.support.tip_in + " repeatedly");
    mode_ = Mode::kRecoverSupport;
    mode_time_ = observation.time;
    return Progress::kRunning;
  }
  if (mode_ != Mode::kExecute)
    recover(view, observation.time, hand);
  else if (step_.action == StepAction::kAdvance && !view.covered && isWrongBranch(view.branch_position.branch) &&
           view.branch_position.depth > BranchEntries::kDepth)
    return retry(Mode::kLeaveBranch, view, observation.time,
                 "entered " + locator().name(view.branch_position.branch) + " repeatedly", retries);
  else if (step_.action == StepAction::kAdvance && view.hand.insertion > step_.retry.deepest)
    return retry(Mode::kPullBack, view, observation.time, "passed its goal repeatedly", retries);
  else if (step_.action == StepAction::kAdvance && isStalled(view, observation.time))
    return retry(Mode::kPullBack, view, observation.time, "makes no progress", retries);
  else
    execute(view, hand);
  return Progress::kRunning;
}

/** Waits for the end of the operator's injection, which begins with the step. */
Progress StepExecution::inject(const Observation& observation)
{
  const bool has_begun = observation.time > begin_time_;
  if (!has_begun || observation.is_injecting)
    return Progress::kRunning;
  return fail(at(observation, active_),
              formatted("%.2g of %.2g ml were injected: no opening of ",
                        1e6 * (observation.injected_volume - begin_injected_), 1e6 * step_.volume) +
                  step_.instrument + " was in the vessel");
}

void StepExecution::execute(const InstrumentView& view, OperatorHand& hand) const
{
  const scene::HandScene& limits = setting_.hand;
  const double turn = std::clamp(limits.speed_scale * step_.turn_speed, -limits.max_turn, limits.max_turn);
  switch (step_.action)
  {
    case StepAction::kAdvance:
      hand.target_speed = insertionSpeed(view, step_.speed);
      hand.target_turn_speed = turn;
      if (route_)
        if (const std::optional<TipSteering> steering = steeringOf(*route_, view, limits.max_turn))
        {
          hand.target_turn_speed = steering->turn_speed;
          hand.target_speed *= steering->speed_share;
        }
      break;
    case StepAction::kWithdraw:
      hand.target_speed = insertionSpeed(view, -step_.speed);
      hand.target_turn_speed = turn;
      break;
    case StepAction::kRotate:
      hand.target_turn_speed = step_.until.turned < 0.0 ? -std::abs(turn) : turn;
      break;
    case StepAction::kInflate:
    case StepAction::kExchange:
    case StepAction::kWait:
    case StepAction::kInject:
      break;
  }
}

/** Insertion speed under the present force: reduced linearly from kSlowdownShare of the force limit to zero at the
 *  limit. */
double StepExecution::insertionSpeed(const InstrumentView& view, double speed) const
{
  const scene::HandScene& limits = setting_.hand;
  const double limit = speed > 0.0 ? limits.push_force : limits.pull_force;
  const double against = speed > 0.0 ? view.hand.force : -view.hand.force;
  const double share = (limit - against) / ((1.0 - kSlowdownShare) * limit);
  const double scaled = std::clamp(limits.speed_scale * speed, -limits.max_speed, limits.max_speed);
  return std::clamp(share, 0.0, 1.0) * scaled;
}

bool StepExecution::isWrongBranch(int branch) const
{
  return branch >= 0 && !on_way_[static_cast<std::size_t>(branch)];
}

bool StepExecution::isStalled(const InstrumentView& view, double time)
{
  const bool outside = view.hand.insertion <= 0.0;
  if (outside ? std::abs(view.hand.insertion - progress_insertion_) > kProgress
              : (view.tip - progress_tip_).norm() > kProgress)
    noteProgress(view, time);
  return time - progress_time_ > setting_.hand.patience;
}

void StepExecution::noteProgress(const InstrumentView& view, double time)
{
  progress_time_ = time;
  progress_tip_ = view.tip;
  progress_insertion_ = view.hand.insertion;
}

void StepExecution::enter(Mode mode, const InstrumentView& view, double time)
{
  mode_ = mode;
  mode_insertion_ = view.hand.insertion;
  mode_rotation_ = view.hand.rotation;
  mode_time_ = time;
}

/** Starts a retry, or fails when their number is exhausted. */
Progress StepExecution::retry(Mode mode, const InstrumentView& view, double time, const std::string& why, int& retries)
{
  if (retries == step_.retry.times)
    return fail(view, why + ", after " + std::to_string(retries) + " retries");
  ++retries;
  enter(mode, view, time);
  return Progress::kRunning;
}

/** Executes the modes of a retry in sequence: leave the wrong branch, pull back, rotate. Each mode ends at its goal or
 *  after kModeLimit. */
void StepExecution::recover(const InstrumentView& view, double time, OperatorHand& hand)
{
  const bool late = time - mode_time_ > kModeLimit;
  const scene::RetryScene& retry = step_.retry;
  if (mode_ == Mode::kLeaveBranch)
  {
    if (late || !isWrongBranch(view.branch_position.branch))
      return enter(Mode::kPullBack, view, time);
    hand.target_speed = insertionSpeed(view, -kPullBackSpeed);
  }
  else if (mode_ == Mode::kPullBack)
  {
    if (late || mode_insertion_ - view.hand.insertion >= retry.back)
      return enter(Mode::kRotate, view, time);
    hand.target_speed = insertionSpeed(view, -kPullBackSpeed);
  }
  else if (late || std::abs(view.hand.rotation - mode_rotation_) >= std::abs(retry.turn))
  {
    enter(Mode::kExecute, view, time);
    noteProgress(view, time);
  }
  else
    hand.target_turn_speed = std::copysign(std::min(kFastestTurn, setting_.hand.max_turn), retry.turn);
}

/** True if the tip of an instrument is in the support's branch or beyond. */
bool StepExecution::isSupportPosition(const InstrumentView& view) const
{
  const int branch = view.branch_position.branch;
  return branch >= 0 && locator().pathBetween(setting_.entry_branch, branch)[static_cast<std::size_t>(support_branch_)];
}

/** True if, for longer than HandScene::patience, neither the support nor the active instrument has been in the
 *  support's branch. */
bool StepExecution::hasLostSupport(const Observation& observation)
{
  if (support_ < 0 || isSupportPosition(at(observation, support_)) || isSupportPosition(at(observation, active_)))
    lost_since_ = -1.0;
  else if (lost_since_ < 0.0)
    lost_since_ = observation.time;
  return lost_since_ >= 0.0 && observation.time - lost_since_ > setting_.hand.patience;
}

/** Withdraws the instrument into its support. */
Progress StepExecution::recoverSupport(const Observation& observation, OperatorHand& hand)
{
  const InstrumentView& view = at(observation, active_);
  const double end = at(observation, support_).hand.insertion - kRecoveryDepth;
  if (view.hand.insertion <= end || observation.time - mode_time_ > kModeLimit)
    return Progress::kSupportLost;
  hand.target_speed = insertionSpeed(view, -kPullBackSpeed);
  return Progress::kRunning;
}

Progress StepExecution::fail(const InstrumentView& view, const std::string& why)
{
  failure_ = why + "; the tip of " + step_.instrument + " is in " + locator().name(view.branch_position.branch) +
             formatted(", %.1f mm beyond its ostium, at ", 1e3 * view.branch_position.depth) + inMillimetres(view.tip);
  return Progress::kFailed;
}

void StepExecution::archive(Archive& archive)
{
  archive(mode_, begin_time_, begin_insertion_, begin_rotation_, begin_injected_, reached_since_, lost_since_,
          progress_time_, progress_insertion_, progress_tip_, mode_insertion_, mode_rotation_, mode_time_);
}

}  // namespace endovascular_sim::procedure
