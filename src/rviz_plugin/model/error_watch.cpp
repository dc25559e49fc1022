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
  if (is_changed && step.outcome == ProcedureStep::LOST)
    return "Support lost: an earlier step is repeated";
  if (is_changed && step.outcome == ProcedureStep::FAILED)
    return "Step failed: " + step.failure;
  if (is_wrong)
    return "Wrong branch" + (branch.empty() ? std::string() : ": " + branch) + "; pull back, twist, push";
  return {};
}

std::string ErrorWatch::follow(const SessionProgress& progress)
{
  if (progress.run != run_)
    errors_ = 0;
  run_ = progress.run;
  const bool is_new = progress.errors > errors_;
  errors_ = progress.errors;
  return is_new ? "Error: " + progress.last_error : std::string();
}

}  // namespace endovascular_sim::rviz_plugin
