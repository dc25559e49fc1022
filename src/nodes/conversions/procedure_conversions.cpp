#include "nodes/conversions/procedure_conversions.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "common/error.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{

procedure::StepRecord fromMessage(const ProcedureStep& message)
{
  if (message.outcome > static_cast<std::uint8_t>(procedure::Progress::kSupportLost))
    throw InputError(names::kProcedureStep, "outcome", "must be one of those of ProcedureStep");
  if (!std::isfinite(message.begin) || !std::isfinite(message.time))
    throw InputError(names::kProcedureStep, "begin, time", "must be finite");
  procedure::StepRecord record;
  record.name = message.name;
  record.phase = message.phase;
  record.begin = message.begin;
  record.end = message.time;
  record.retries = static_cast<int>(message.retries);
  record.wrong_branches = static_cast<int>(message.wrong_branches);
  record.step = std::max(message.step_of_procedure, 1U) - 1U;
  record.outcome = static_cast<procedure::Progress>(message.outcome);
  return record;
}

std::vector<ProcedureStep> ProcedureMessages::changes(const procedure::Operator& scripted, std::uint64_t steps,
                                                      bool repeats)
{
  const std::vector<procedure::StepRecord>& records = scripted.records();
  std::vector<ProcedureStep> messages;
  for (std::size_t k = newest_.begun == 0 ? 0 : newest_.begun - 1; k < records.size(); ++k)
  {
    const procedure::StepRecord& step = records[k];
    const bool is_changed = k + 1 != newest_.begun || static_cast<std::uint8_t>(step.outcome) != newest_.outcome ||
                            static_cast<std::uint32_t>(step.retries) != newest_.retries ||
                            static_cast<std::uint32_t>(step.wrong_branches) != newest_.wrong_branches;
    if (!is_changed && !repeats)
      continue;
    newest_.step = steps;
    newest_.time = step.end;
    newest_.begun = static_cast<std::uint32_t>(k + 1);
    newest_.phase = step.phase;
    newest_.name = step.name;
    newest_.begin = step.begin;
    newest_.retries = static_cast<std::uint32_t>(step.retries);
    newest_.wrong_branches = static_cast<std::uint32_t>(step.wrong_branches);
    newest_.outcome = static_cast<std::uint8_t>(step.outcome);
    newest_.failure = scripted.failure();
    newest_.hint = step.hint;
    newest_.step_of_procedure = static_cast<std::uint32_t>(step.step + 1);
    newest_.steps_of_procedure = static_cast<std::uint32_t>(scripted.steps());
    messages.push_back(newest_);
  }
  return messages;
}

}  // namespace endovascular_sim::nodes
