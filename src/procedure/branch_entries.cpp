#include "procedure/branch_entries.h"

#include <algorithm>

#include "common/archive.h"
#include "common/archive_checks.h"

namespace endovascular_sim::procedure
{
namespace
{

/** Branch that a step is to reach; empty without one. */
const std::string& goalOf(const scene::StepScene& step)
{
  return step.until.tip_in.empty() ? step.until.balloon_in : step.until.tip_in;
}

}  // namespace

int instrumentOf(const scene::Scene& scene, const std::string& name)
{
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
    if (scene.instruments[k].instrument.name == name)
      return static_cast<int>(k);
  return -1;
}

std::vector<scene::StepScene> expandedSteps(const scene::ProcedureScene& procedure)
{
  std::vector<scene::StepScene> steps;
  for (const scene::StepScene& step : procedure.steps)
  {
    steps.push_back(step);
    if (step.action != scene::StepAction::kExchange)
      continue;
    steps.back().action = scene::StepAction::kWithdraw;
    steps.back().until = scene::GoalScene();
    steps.back().until.outside = true;
    steps.push_back(step);
    steps.back().action = scene::StepAction::kAdvance;
    steps.back().instrument = step.replacement;
  }
  return steps;
}

BranchEntries::BranchEntries(const scene::Scene& scene, const BranchLocator& locator, int entered)
  : of_instrument_(scene.instruments.size()), tips_(scene.instruments.size())
{
  const auto branches = static_cast<std::size_t>(locator.branches());
  const std::vector<scene::StepScene> steps =
      scene.procedure ? expandedSteps(*scene.procedure) : std::vector<scene::StepScene>();
  for (const scene::StepScene& step : steps)
  {
    const int instrument = instrumentOf(scene, step.instrument);
    const int goal = goalOf(step).empty() ? -1 : locator.find(goalOf(step));
    of_step_.push_back(locator.pathBetween(entered, step.any_branch ? -1 : goal));
    moved_.push_back(step.action == scene::StepAction::kAdvance && goal >= 0 ? instrument : -1);
    if (instrument < 0 || goal < 0)
      continue;
    std::vector<bool>& permitted = of_instrument_[static_cast<std::size_t>(instrument)];
    permitted.resize(branches, false);
    for (std::size_t b = 0; b < branches; ++b)
      permitted[b] = permitted[b] || of_step_.back()[b];
  }
  for (std::vector<bool>& permitted : of_instrument_)
    if (permitted.empty())
      permitted.assign(branches, true);
}

const std::vector<bool>& BranchEntries::permitted(std::size_t instrument, int step) const
{
  const auto k = static_cast<std::size_t>(std::max(step, 0));
  if (step >= 0 && k < moved_.size() && moved_[k] == static_cast<int>(instrument))
    return of_step_[k];
  return of_instrument_[instrument];
}

void BranchEntries::add(const Observation& observation, int step)
{
  for (std::size_t k = 0; k < tips_.size(); ++k)
  {
    Tip& tip = tips_[k];
    const InstrumentView& view = observation.instruments[k];
    const int branch = view.covered ? -1 : view.branch_position.branch;
    const bool wrong = branch >= 0 && !permitted(k, step)[static_cast<std::size_t>(branch)];
    if (tip.occupied != branch)
      tip.occupied = -1;
    tip.inside = tip.inside && wrong && tip.occupied >= 0;
    tip.enters = branch >= 0 && tip.occupied < 0 && view.branch_position.depth > kDepth;
    if (tip.enters)
      tip.occupied = branch;
    tip.enters = tip.enters && wrong;
    tip.inside = tip.inside || tip.enters;
  }
}

int BranchEntries::entries() const
{
  return static_cast<int>(std::count_if(tips_.begin(), tips_.end(), [](const Tip& tip) { return tip.enters; }));
}

void BranchEntries::archive(Archive& archive)
{
  for (Tip& tip : tips_)
  {
    archive(tip.occupied, tip.inside, tip.enters);
    if (archive.reading())
      requireIndex(tip.occupied, -1, static_cast<int>(of_instrument_.front().size()));
  }
}

}  // namespace endovascular_sim::procedure
