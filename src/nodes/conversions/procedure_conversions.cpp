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

}  // namespace endovascular_sim::nodes
