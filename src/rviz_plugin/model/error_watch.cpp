#include "rviz_plugin/model/error_watch.h"

namespace endovascular_sim::rviz_plugin
{

std::string ErrorWatch::follow(const ProcedureStep& step, const std::string& branch)
{
  const bool is_same = step.begun == begun_;
  // Steps that ended before a state was loaded are published again, with the wrong branches of then.
  const bool is_past = !is_same && step.outcome == ProcedureStep::DONE;
  const bool is_wrong = !is_past && step.wrong_branches > (is_same ? wrong_branches_ : 0U);
  const bool is_changed = !is_same || step.outcome != outcome_;
  begun_ = step.begun;
  wrong_branches_ = step.wrong_branches;
  outcome_ = step.outcome;
  if (is_changed && (step.outcome == ProcedureStep::LOST || step.outcome == ProcedureStep::FAILED))
  {
    wrong_branch_.reset();
    return step.outcome == ProcedureStep::LOST ? "Support lost: an earlier step is repeated"
                                               : "Step failed: " + step.failure;
  }
  if (!is_wrong)
    return {};
  wrong_branch_ = branch;
  return "Wrong branch" + (branch.empty() ? std::string() : ": " + branch) + "; pull back, twist, push";
}

std::string ErrorWatch::follow(const SessionProgress& progress)
{
  if (progress.run != run_)
    errors_ = 0;
  run_ = progress.run;
  const bool is_new = progress.errors > errors_;
  errors_ = progress.errors;
  if (!is_new)
    return {};
  wrong_branch_.reset();
  return "Error: " + progress.last_error;
}

bool ErrorWatch::isOver(const std::string& branch) const
{
  if (!wrong_branch_)
    return false;
  const bool has_left = !wrong_branch_->empty() && !branch.empty() && branch != *wrong_branch_;
  return has_left || outcome_ == ProcedureStep::DONE;
}

}  // namespace endovascular_sim::rviz_plugin
