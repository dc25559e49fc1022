#include "procedure/operator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/error.h"
#include "common/text/format.h"
#include "common/units.h"

namespace endovascular_sim::procedure
{
namespace
{

constexpr double kPressureShare = 0.9;    // share of the pressure that a person has to reach
constexpr double kAmbientPressure = 1e4;  // pressure of an empty balloon that a person need not reach [Pa]
constexpr double kSlowdownShare = 0.6;    // share of the force limit from which the operator slows down

using scene::StepAction;
using scene::StepScene;

/** @return @p from moved towards @p to by at most @p limit */
double towards(double from, double to, double limit)
{
  return from + std::clamp(to - from, -limit, limit);
}

}  // namespace

Operator::Operator(const scene::Scene& scene, const vessel::CentrelineTree& tree, const Eigen::Vector3d& entry)
  : Operator(scene, std::make_shared<const BranchLocator>(tree, scene.procedure->branches), entry)
{
}

Operator::Operator(const scene::Scene& scene, std::shared_ptr<const BranchLocator> branches,
                   const Eigen::Vector3d& entry)
  : scene_(scene),
    hand_(scene.procedure->hand),
    branches_(std::move(branches)),
    entry_(entry),
    entry_branch_(locator().at(entry).branch),
    observation_interval_(
        static_cast<std::uint64_t>(std::max(1.0, std::round(hand_.reaction / scene.solver.time_step)))),
    steps_(expandedSteps(*scene.procedure)),
    entries_(scene, locator(), entry_branch_)
{
  checkBranches();
  for (const scene::DrivenInstrument& driven : scene.instruments)
  {
    Hand hand;
    hand.insertion = driven.drive.insertionAt(0.0);
    hand.rotation = driven.drive.rotationAt(0.0);
    hand.scripted = driven.drive.source == scene::DriveSource::kProcedure;
    hands_.push_back(hand);
  }
  commands_.resize(hands_.size());
}

void Operator::checkBranches() const
{
  const auto check = [this](const std::string& name, std::size_t step, const std::string& key)
  {
    if (!name.empty() && locator().find(name) < 0)
      throw InputError(scene_.file, "procedure.steps." + std::to_string(step) + "." + key,
                       "the vessel has no branch '" + name + "'; known: " + locator().names());
  };
  for (std::size_t k = 0; k < scene_.procedure->steps.size(); ++k)
  {
    const StepScene& step = scene_.procedure->steps[k];
    check(step.until.tip_in, k, "until");
    check(step.until.balloon_in, k, "until");
    check(step.support.tip_in, k, "support");
  }
}

std::string Operator::nameOf(const StepScene& step) const
{
  const auto goal = [&step](const std::string& verb)
  {
    std::string text = verb + " " + step.instrument;
    if (!step.until.tip_in.empty())
      text += " until its tip is in " + step.until.tip_in;
    if (!step.until.balloon_in.empty())
      text += " until its balloon is in " + step.until.balloon_in;
    if (!std::isnan(step.until.beyond))
      text += formatted(" by %.1f mm", 1e3 * step.until.beyond);
    if (step.until.outside)
      text += " until it is out";
    if (!std::isnan(step.until.insertion))
      text += formatted(" to %.1f mm", 1e3 * step.until.insertion);
    if (!std::isnan(step.until.by))
      text += formatted(" by %.1f mm", 1e3 * step.until.by);
    if (!std::isnan(step.until.turned))
      text += formatted(" by %.2f rad", step.until.turned);
    return text;
  };
  switch (step.action)
  {
    case StepAction::kAdvance:
      return goal("advance");
    case StepAction::kWithdraw:
      return goal("withdraw");
    case StepAction::kRotate:
      return goal("rotate");
    case StepAction::kInflate:
      return "inflate " + step.instrument + formatted(" to %.1f atm", step.pressure / units::kAtmosphere);
    case StepAction::kExchange:
    case StepAction::kWait:
      break;
  }
  return formatted("wait %.1f s", step.duration);
}

/** View of a step or, without its own, of the last step before it that has one. */
std::string Operator::viewOf(std::size_t step) const
{
  while (step > 0 && steps_[step].view.empty())
    --step;
  return steps_[step].view;
}

const std::vector<simulation::HandCommand>& Operator::next(const simulation::Simulation& simulation)
{
  if (observesBefore(simulation.steps()))
    observe(procedure::observe(scene_, simulation, locator()));
  return advance(static_cast<double>(simulation.steps() + 1) * scene_.solver.time_step);
}

const std::vector<simulation::HandCommand>& Operator::advance(double end_time)
{
  const double dt = scene_.solver.time_step;
  for (std::size_t k = 0; k < hands_.size(); ++k)
  {
    Hand& hand = hands_[k];
    const scene::DriveScene& drive = scene_.instruments[k].drive;
    if (!hand.scripted)
    {
      commands_[k] = {drive.insertionAt(end_time), drive.rotationAt(end_time), drive.pressureAt(end_time)};
      continue;
    }
    hand.speed = towards(hand.speed, hand.target_speed, hand_.acceleration * dt);
    hand.turn_speed = towards(hand.turn_speed, hand.target_turn_speed, hand_.turn_acceleration * dt);
    hand.insertion += dt * hand.speed;
    hand.rotation += dt * hand.turn_speed;
    commands_[k] = {hand.insertion, hand.rotation, hand.pressure};
  }
  return commands_;
}

void Operator::stop()
{
  for (Hand& hand : hands_)
    hand.target_speed = hand.target_turn_speed = 0.0;
}

void Operator::observe(const Observation& observation)
{
  if (progress_ != Progress::kRunning)
    return;
  if (!begun_)
    begin(observation);
  records_.back().end = observation.time;
  entries_.add(observation, static_cast<int>(current_));
  records_.back().wrong_branches += entries_.entries();
  const bool reached = mode_ != Mode::kRecoverSupport && isReached(observation);
  if (!reached)
    reached_since_ = -1.0;
  else if (reached_since_ < 0.0)
    reached_since_ = observation.time;
  if (reached && observation.time - reached_since_ >= holdTime())
    finishStep(observation.time);
  else if (reached && mode_ == Mode::kExecute)
    stop();
  else
    act(observation);
}

void Operator::begin(const Observation& observation)
{
  begun_ = true;
  StepRecord record;
  record.step = current_;
  record.name = nameOf(step());
  record.phase = step().phase.empty() && !records_.empty() ? records_.back().phase : step().phase;
  record.hint = step().hint;
  record.view = viewOf(current_);
  record.begin = record.end = observation.time;
  records_.push_back(record);
  prepareStep();
  mode_ = Mode::kExecute;
  reached_since_ = lost_since_ = -1.0;
  begin_time_ = progress_time_ = observation.time;
  if (active_ < 0)
    return;
  const InstrumentView& view = observation.instruments[static_cast<std::size_t>(active_)];
  begin_insertion_ = progress_insertion_ = view.hand.insertion;
  begin_rotation_ = view.hand.rotation;
  progress_tip_ = view.tip;
  // An instrument far outside the introducer starts at the insertion from which the introducer senses it.
  if (Hand& hand = hands_[static_cast<std::size_t>(active_)]; view.outside)
    hand.insertion = std::max(hand.insertion, view.hand.insertion);
  if (step().action == StepAction::kInflate)
    hands_[static_cast<std::size_t>(active_)].pressure = step().pressure;
}

/** Sets the members that depend on the step only. */
void Operator::prepareStep()
{
  active_ = instrumentOf(scene_, step().instrument);
  const std::string& branch = step().until.tip_in.empty() ? step().until.balloon_in : step().until.tip_in;
  goal_branch_ = branch.empty() ? -1 : locator().find(branch);
  on_way_ = locator().pathBetween(entry_branch_, step().any_branch ? -1 : goal_branch_);
  route_.reset();
  if (step().steer && goal_branch_ >= 0 && goal_branch_ != entry_branch_)
    route_.emplace(locator(), entry_branch_, entry_, goal_branch_);
  support_ = instrumentOf(scene_, step().support.instrument);
  support_branch_ = locator().find(step().support.tip_in);
}

void Operator::finishStep(double time)
{
  stop();
  records_.back().outcome = Progress::kDone;
  records_.back().end = time;
  begun_ = false;
  if (++current_ == steps_.size())
    progress_ = Progress::kDone;
}

void Operator::fail(const InstrumentView* view, const std::string& why)
{
  stop();
  progress_ = Progress::kFailed;
  records_.back().outcome = Progress::kFailed;
  failure_ = "step " + std::to_string(records_.size()) + " (" + records_.back().name + "): " + why;
  if (view != nullptr)
    failure_ += "; the tip of " + step().instrument + " is in " + locator().name(view->branch_position.branch) +
                formatted(", %.1f mm beyond its ostium, at ", 1e3 * view->branch_position.depth) +
                inMillimetres(view->tip);
}

/** Duration for which the goal of the step must hold [s]. */
double Operator::holdTime() const
{
  const bool is_guided_inflation = scene_.procedure->guided && step().action == StepAction::kInflate;
  return is_guided_inflation ? step().duration : step().until.held;
}

/** True if a balloon has the pressure of the step, or more of it; for a pressure that is not positive, or less. */
bool Operator::hasPressure(const InstrumentView& view) const
{
  return step().pressure > 0.0 ? view.hand.pressure >= kPressureShare * step().pressure
                               : view.hand.pressure <= kPressureShare * step().pressure + kAmbientPressure;
}

bool Operator::isReached(const Observation& observation) const
{
  if (scene_.procedure->guided && step().action == StepAction::kInflate)
    return hasPressure(observation.instruments[static_cast<std::size_t>(active_)]);
  if (step().action == StepAction::kWait || step().action == StepAction::kInflate)
    return observation.time - begin_time_ >= step().duration - 1e-9;
  const InstrumentView& view = observation.instruments[static_cast<std::size_t>(active_)];
  const scene::GoalScene& goal = step().until;
  const double forward = step().action == StepAction::kWithdraw ? -1.0 : 1.0;
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

/** Insertion speed under the present force: reduced linearly from kSlowdownShare of the force limit to zero at the
 *  limit. */
double Operator::insertionSpeed(const InstrumentView& view, double speed) const
{
  const double limit = speed > 0.0 ? hand_.push_force : hand_.pull_force;
  const double against = speed > 0.0 ? view.hand.force : -view.hand.force;
  const double share = (limit - against) / ((1.0 - kSlowdownShare) * limit);
  const double scaled = std::clamp(hand_.speed_scale * speed, -hand_.max_speed, hand_.max_speed);
  return std::clamp(share, 0.0, 1.0) * scaled;
}

void Operator::execute(const InstrumentView& view)
{
  Hand& hand = hands_[static_cast<std::size_t>(active_)];
  const double turn = std::clamp(hand_.speed_scale * step().turn_speed, -hand_.max_turn, hand_.max_turn);
  switch (step().action)
  {
    case StepAction::kAdvance:
      hand.target_speed = insertionSpeed(view, step().speed);
      hand.target_turn_speed = turn;
      steer(view);
      break;
    case StepAction::kWithdraw:
      hand.target_speed = insertionSpeed(view, -step().speed);
      hand.target_turn_speed = turn;
      break;
    case StepAction::kRotate:
      hand.target_turn_speed = step().until.turned < 0.0 ? -std::abs(turn) : turn;
      break;
    case StepAction::kInflate:
    case StepAction::kExchange:
    case StepAction::kWait:
      break;
  }
}

bool Operator::isInWrongBranch(const InstrumentView& view) const
{
  return !view.covered && view.branch_position.branch >= 0 &&
         !on_way_[static_cast<std::size_t>(view.branch_position.branch)];
}

void Operator::act(const Observation& observation)
{
  stop();
  if (active_ < 0 || scene_.procedure->guided)
    return;
  const InstrumentView& view = observation.instruments[static_cast<std::size_t>(active_)];
  if (step().action == StepAction::kInflate)
    return;
  if (observation.time - begin_time_ > step().time_limit)
    return fail(&view, formatted("not done within %.4g s", step().time_limit));
  if (mode_ == Mode::kRecoverSupport)
    return recoverSupport(observation);
  if (hasLostSupport(observation))
    return handleLostSupport(view, observation.time);
  if (mode_ != Mode::kExecute)
    return recover(view, observation.time);
  if (step().action == StepAction::kAdvance && isInWrongBranch(view) &&
      view.branch_position.depth > BranchEntries::kDepth)
  {
    if (retry(Mode::kLeaveBranch, view, "entered " + locator().name(view.branch_position.branch) + " repeatedly"))
      mode_time_ = observation.time;
    return;
  }
  const bool missed = view.hand.insertion > step().retry.deepest;
  if (step().action == StepAction::kAdvance && (missed || isStalled(view, observation.time)))
  {
    if (retry(Mode::kPullBack, view, missed ? "passed its goal repeatedly" : "makes no progress"))
      mode_time_ = observation.time;
    return;
  }
  execute(view);
}

}  // namespace endovascular_sim::procedure
