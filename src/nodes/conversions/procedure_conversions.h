#pragma once

#include "endovascular_sim/ProcedureStep.h"
#include "procedure/operator.h"

namespace endovascular_sim::nodes
{

/** Converts a message to the record of a procedure step, omitting the other fields.
 *  @throws InputError for an unknown outcome, or a time that is not finite */
procedure::StepRecord fromMessage(const ProcedureStep& message);

}  // namespace endovascular_sim::nodes
