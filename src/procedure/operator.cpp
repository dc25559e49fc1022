#include "procedure/operator.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/error.h"

namespace endovascular_sim::procedure
{
namespace
{

constexpr double kNoticed = 3e-3;  // m beyond its ostium where a tip is seen to be in a wrong branch
constexpr double kSlowFrom = 0.6;  // of the force at which he stops: from here he pushes more slowly

using scene::StepAction;
using scene::StepScene;

int instrumentOf(const scene::Scene& scene, const std::string& name)
{
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
    if (scene.instruments[k].instrument.name == name)
      return static_cast<int>(k);
  return -1;
}

std::string inMillimetres(const Eigen::Vector3d& point)
{
  char text[80];
  std::snprintf(text, sizeof text, "(%.1f, %.1f, %.1f) mm", 1e3 * point.x(), 1e3 * point.y(), 1e3 * point.z());
  return text;
}

std::string written(const char* format, double value)
{
  char text[80];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/** @return @p from moved towards @p to by at most @p most */
double towards(double from, double to, double most)
{
  return from + std::clamp(to - from, -most, most);
}

}  // namespace

Operator::Operator(const scene::Scene& scene, const vessel::CentrelineTree& tree, const Eigen::Vector3d& entry)
  : scene_(scene),
    hand_(scene.procedure->hand),
    places_(tree, scene.procedure->branches),
    entered_(places_.at(entry).branch),
    look_every_(static_cast<std::uint64_t>(std::max(1.0, std::round(hand_.reaction / scene.solver.time_step))))
{
  expand();
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

/** An exchange is a withdrawal and an insertion. */
void Operator::expand()
{
  for (const StepScene& step : scene_.procedure->steps)
  {
    steps_.push_back(step);
    if (step.action != StepAction::kExchange)
      continue;
    steps_.back().action = StepAction::kWithdraw;
    steps_.back().until = scene::GoalScene();
    steps_.back().until.outside = true;
    steps_.push_back(step);
    steps_.back().action = StepAction::kAdvance;
    steps_.back().instrument = step.replacement;
  }
}

void Operator::checkBranches() const
{
  const auto check = [this](const std::string& name, std::size_t step, const std::string& key)
  {
    if (!name.empty() && places_.find(name) < 0)
      throw InputError(scene_.file, "procedure.steps." + std::to_string(step) + "." + key,
                       "the vessel has no branch '" + name + "'; it has " + places_.names());
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
      text += written(" by %.1f mm", 1e3 * step.until.beyond);
    if (step.until.outside)
      text += " until it is out";
    if (!std::isnan(step.until.insertion))
      text += written(" to %.1f mm", 1e3 * step.until.insertion);
    if (!std::isnan(step.until.by))
      text += written(" by %.1f mm", 1e3 * step.until.by);
    if (!std::isnan(step.until.turned))
      text += written(" by %.2f rad", step.until.turned);
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
      return "inflate " + step.instrument + written(" to %.1f atm", step.pressure / 101325.0);
    case StepAction::kExchange:
    case StepAction::kWait:
      break;
  }
  return written("wait %.1f s", step.duration);
}

const std::vector<simulation::HandCommand>& Operator::next(const simulation::Simulation& simulation)
{
  if (looksBefore(simulation.steps()))
    see(observe(scene_, simulation, places_));
  return move(static_cast<double>(simulation.steps() + 1) * scene_.solver.time_step);
}

const std::vector<simulation::HandCommand>& Operator::move(double end_time)
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
    hand.speed = towards(hand.speed, hand.wanted, hand_.acceleration * dt);
    hand.turn_speed = towards(hand.turn_speed, hand.wanted_turn, hand_.turn_acceleration * dt);
    hand.insertion += dt * hand.speed;
    hand.rotation += dt * hand.turn_speed;
    commands_[k] = {hand.insertion, hand.rotation, hand.pressure};
  }
  return commands_;
}

void Operator::rest()
{
  for (Hand& hand : hands_)
    hand.wanted = hand.wanted_turn = 0.0;
}

void Operator::see(const Observation& seen)
{
  if (progress_ != Progress::kRunning)
    return;
  if (!begun_)
    begin(seen);
  records_.back().end = seen.time;
  const bool reached = mode_ != Mode::kReturn && isReached(seen);
  if (!reached)
    reached_since_ = -1.0;
  else if (reached_since_ < 0.0)
    reached_since_ = seen.time;
  if (reached && seen.time - reached_since_ >= step().until.held)
    finishStep(seen.time);
  else if (reached && mode_ == Mode::kGo)
    rest();
  else
    act(seen);
}

void Operator::begin(const Observation& seen)
{
  begun_ = true;
  StepRecord record;
  record.step = current_;
  record.name = nameOf(step());
  record.phase = step().phase.empty() && !records_.empty() ? records_.back().phase : step().phase;
  record.begin = record.end = seen.time;
  records_.push_back(record);
  prepareStep();
  mode_ = Mode::kGo;
  reached_since_ = lost_since_ = -1.0;
  begin_time_ = progress_time_ = seen.time;
  if (active_ < 0)
    return;
  const InstrumentView& view = seen.instruments[static_cast<std::size_t>(active_)];
  begin_insertion_ = progress_insertion_ = view.hand.insertion;
  begin_rotation_ = view.hand.rotation;
  progress_tip_ = view.tip;
  // An instrument that waits further out than the introducer feels anything is brought there first.
  if (Hand& hand = hands_[static_cast<std::size_t>(active_)]; view.outside)
    hand.insertion = std::max(hand.insertion, view.hand.insertion);
  if (step().action == StepAction::kInflate)
    hands_[static_cast<std::size_t>(active_)].pressure = step().pressure;
}

/** What follows from the step alone. */
void Operator::prepareStep()
{
  active_ = instrumentOf(scene_, step().instrument);
  const std::string& branch = step().until.tip_in.empty() ? step().until.balloon_in : step().until.tip_in;
  goal_branch_ = branch.empty() ? -1 : places_.find(branch);
  on_way_ = places_.wayBetween(entered_, step().any_branch ? -1 : goal_branch_);
  support_ = instrumentOf(scene_, step().support.instrument);
  support_branch_ = places_.find(step().support.tip_in);
}

void Operator::finishStep(double time)
{
  rest();
  records_.back().outcome = Progress::kDone;
  records_.back().end = time;
  begun_ = false;
  if (++current_ == steps_.size())
    progress_ = Progress::kDone;
}

void Operator::fail(const InstrumentView* view, const std::string& why)
{
  rest();
  progress_ = Progress::kFailed;
  records_.back().outcome = Progress::kFailed;
  failure_ = "step " + std::to_string(records_.size()) + " (" + records_.back().name + "): " + why;
  if (view != nullptr)
    failure_ += "; the tip of " + step().instrument + " is in " + places_.name(view->place.branch) +
                written(", %.1f mm beyond its ostium, at ", 1e3 * view->place.depth) + inMillimetres(view->tip);
}

bool Operator::isReached(const Observation& seen) const
{
  if (step().action == StepAction::kWait || step().action == StepAction::kInflate)
    return seen.time - begin_time_ >= step().duration - 1e-9;
  const InstrumentView& view = seen.instruments[static_cast<std::size_t>(active_)];
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
    if (places_.at(point).branch != goal_branch_)
      return false;
    if (!std::isnan(goal.beyond) && forward * (places_.depthIn(goal_branch_, point) - goal.beyond) < 0.0)
      return false;
  }
  if (!std::isnan(goal.insertion) && forward * (view.hand.insertion - goal.insertion) < 0.0)
    return false;
  if (!std::isnan(goal.by) && forward * (view.hand.insertion - begin_insertion_) < goal.by)
    return false;
  return std::isnan(goal.turned) || std::abs(view.hand.rotation - begin_rotation_) >= std::abs(goal.turned);
}

/** Speed at which he moves on against the force that he feels. */
double Operator::pushed(const InstrumentView& view, double speed) const
{
  const double limit = speed > 0.0 ? hand_.push_force : hand_.pull_force;
  const double against = speed > 0.0 ? view.hand.force : -view.hand.force;
  const double share = (limit - against) / ((1.0 - kSlowFrom) * limit);
  const double scaled = std::clamp(hand_.speed_scale * speed, -hand_.max_speed, hand_.max_speed);
  return std::clamp(share, 0.0, 1.0) * scaled;
}

void Operator::go(const InstrumentView& view)
{
  Hand& hand = hands_[static_cast<std::size_t>(active_)];
  const double turn = std::clamp(hand_.speed_scale * step().turn_speed, -hand_.max_turn, hand_.max_turn);
  switch (step().action)
  {
    case StepAction::kAdvance:
      hand.wanted = pushed(view, step().speed);
      hand.wanted_turn = turn;
      break;
    case StepAction::kWithdraw:
      hand.wanted = pushed(view, -step().speed);
      hand.wanted_turn = turn;
      break;
    case StepAction::kRotate:
      hand.wanted_turn = step().until.turned < 0.0 ? -std::abs(turn) : turn;
      break;
    case StepAction::kInflate:
    case StepAction::kExchange:
    case StepAction::kWait:
      break;
  }
}

void Operator::act(const Observation& seen)
{
  rest();
  if (active_ < 0)
    return;
  const InstrumentView& view = seen.instruments[static_cast<std::size_t>(active_)];
  if (step().action == StepAction::kInflate)
    return;
  if (seen.time - begin_time_ > step().time_limit)
    return fail(&view, written("not done within %.0f s", step().time_limit));
  if (mode_ == Mode::kReturn)
    return comeBack(seen);
  if (missesSupport(seen))
    return giveUp(view, seen.time);
  if (mode_ != Mode::kGo)
    return manoeuvre(view, seen.time);
  const bool astray = !view.covered && view.place.branch >= 0 && !on_way_[static_cast<std::size_t>(view.place.branch)];
  if (step().action == StepAction::kAdvance && astray && view.place.depth > kNoticed)
  {
    ++records_.back().wrong_branches;
    if (tryAgain(Mode::kLeave, view, "entered " + places_.name(view.place.branch) + " again and again"))
      mode_time_ = seen.time;
    return;
  }
  const bool missed = view.hand.insertion > step().retry.deepest;
  if (step().action == StepAction::kAdvance && (missed || stalls(view, seen.time)))
  {
    if (tryAgain(Mode::kBack, view, missed ? "passed its goal again and again" : "makes no progress"))
      mode_time_ = seen.time;
    return;
  }
  go(view);
}

}  // namespace endovascular_sim::procedure
