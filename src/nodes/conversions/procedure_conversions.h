#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "endovascular_sim/ProcedureStep.h"
#include "procedure/operator.h"

namespace endovascular_sim::nodes
{

/** Converts a message to the record of a procedure step, omitting the other fields.
 *  @throws InputError for an unknown outcome, or a time that is not finite */
procedure::StepRecord fromMessage(const ProcedureStep& message);

/** Messages of the progress of an operator: one for each record that begins or changes. */
class ProcedureMessages
{
public:
  /** Messages for what has changed since the last call, without header: the newest record, and the previous one when it
   * has ended.
   *  @param steps number of steps before the present one
   *  @param repeats true: also the newest record without a change, with the time of its last observation */
  std::vector<ProcedureStep> changes(const procedure::Operator& scripted, std::uint64_t steps, bool repeats);

private:
  ProcedureStep newest_;  ///< last message
};

}  // namespace endovascular_sim::nodes
