#include "procedure/operator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/error.h"

namespace endovascular_sim::procedure
{
namespace
{

constexpr std::uint64_t kMaxRecords = 1000000;

using scene::StepScene;

}  // namespace

Operator::Operator(const scene::Scene& scene, const vessel::CentrelineTree& tree, const Eigen::Vector3d& entry)
  : Operator(scene, std::make_shared<const BranchLocator>(tree, scene.procedure->branches), entry)
{
}

Operator::Operator(const scene::Scene& scene, std::shared_ptr<const BranchLocator> branches,
                   const Eigen::Vector3d& entry)
  : scene_(scene),
    branches_(std::move(branches)),
    entry_branch_(locator().at(entry).branch),
    observation_interval_(
        static_cast<std::uint64_t>(std::max(1.0, std::round(scene.procedure->hand.reaction / scene.solver.time_step)))),
    steps_(expandedSteps(*scene.procedure)),
    entries_(scene, locator(), entry_branch_),
    hands_(scene),
    execution_({scene.procedure->hand, scene.procedure->guided, branches_, entry, entry_branch_})
{
  checkBranches();
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

/** View of a step or, without its own, of the last step before it that has one. */
std::string Operator::viewOf(std::size_t step) const
{
  while (step > 0 && steps_[step].view.empty())
    --step;
  return steps_[step].view;
}

const std::vector<drive::HandCommand>& Operator::next(const simulation::Simulation& simulation)
{
  if (observesBefore(simulation.steps()))
    observe(procedure::observe(scene_, simulation, locator()));
  return advance(static_cast<double>(simulation.steps() + 1) * scene_.solver.time_step);
}

/** True while a step runs that the operator does, not a person. */
bool Operator::asksThePatient() const
{
  return begun_ && progress_ == Progress::kRunning && !scene_.procedure->guided;
}

std::optional<bool> Operator::wantedHyperaemia() const
{
  return asksThePatient() ? step().hyperaemia : std::nullopt;
}

std::optional<bool> Operator::wantedBreathHold() const
{
  return asksThePatient() ? step().breath_held : std::nullopt;
}

std::optional<contrast::Injection> Operator::takeInjection()
{
  if (!std::exchange(injects_, false))
    return std::nullopt;
  return scene_.contrast->injection(step().volume, step().rate, step().rise);
}

void Operator::observe(const Observation& observation)
{
  if (progress_ != Progress::kRunning)
    return;
  if (!begun_)
    begin(observation);
  StepRecord& record = records_.back();
  record.end = observation.time;
  entries_.add(observation, static_cast<int>(current_));
  record.wrong_branches += entries_.entries();
  record.outcome = execution_.observe(observation, hands_, record.retries);
  begun_ = record.outcome == Progress::kRunning || record.outcome == Progress::kFailed;
  if (record.outcome == Progress::kDone && ++current_ == steps_.size())
    progress_ = Progress::kDone;
  else if (record.outcome == Progress::kFailed)
    fail();
  else if (record.outcome == Progress::kSupportLost)
    repeatSupport();
}

void Operator::begin(const Observation& observation)
{
  begun_ = true;
  prepareStep();
  StepRecord record;
  record.step = current_;
  describe(record, records_.empty() ? nullptr : &records_.back());
  record.begin = record.end = observation.time;
  records_.push_back(record);
  execution_.begin(observation, hands_);
  injects_ = step().action == scene::StepAction::kInject && !scene_.procedure->guided;
}

/** Prepares the execution of the current step. */
void Operator::prepareStep()
{
  const auto losses = std::count_if(records_.begin(), records_.end(),
                                    [this](const StepRecord& record)
                                    { return record.step == current_ && record.outcome == Progress::kSupportLost; });
  execution_.prepare(step(), instrumentOf(scene_, step().instrument), instrumentOf(scene_, step().support.instrument),
                     static_cast<int>(losses));
}

/** Resumes from the phase that brings the support back. */
void Operator::repeatSupport()
{
  const auto again = std::find_if(steps_.begin(), steps_.end(),
                                  [this](const StepScene& one) { return one.phase == step().support.again_from; });
  current_ = static_cast<std::size_t>(again - steps_.begin());
}

void Operator::fail()
{
  progress_ = Progress::kFailed;
  failure_ = "step " + std::to_string(records_.size()) + " (" + records_.back().name + "): " + execution_.failure();
}

/** Sets the texts of a record from its step. @param before record before it; null for the first one */
void Operator::describe(StepRecord& record, const StepRecord* before) const
{
  const StepScene& step = steps_[record.step];
  record.name = nameOf(step);
  record.hint = step.hint;
  record.view = viewOf(record.step);
  record.phase = step.phase.empty() && before != nullptr ? before->phase : step.phase;
}

void Operator::archiveRecords(Archive& archive)
{
  std::uint64_t count = records_.size();
  archive(count);
  if (archive.reading() && count > kMaxRecords)
    throw ArchiveError("has an implausible number of steps");
  records_.resize(static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < records_.size(); ++k)
  {
    StepRecord& record = records_[k];
    std::uint64_t step = record.step;
    archive(step, record.begin, record.end, record.retries, record.wrong_branches, record.outcome);
    if (archive.reading() && step >= steps_.size())
      throw ArchiveError("refers to a step that the procedure does not have");
    record.step = static_cast<std::size_t>(step);
    describe(record, k > 0 ? &records_[k - 1] : nullptr);
  }
}

void Operator::archive(Archive& archive)
{
  std::uint64_t current = current_;
  archive(current, begun_, progress_, execution_, hands_);
  archiveRecords(archive);
  archive(entries_);
  if (!archive.reading())
    return;
  if (current > steps_.size() || (current == steps_.size() && progress_ == Progress::kRunning))
    throw ArchiveError("refers to a step that the procedure does not have");
  current_ = static_cast<std::size_t>(current);
  if (begun_ && current_ < steps_.size())
    prepareStep();
  if (progress_ == Progress::kFailed)
    failure_ =
        "step " + std::to_string(records_.size()) + " (" + records_.back().name + ") failed before the state was saved";
}

}  // namespace endovascular_sim::procedure
