#pragma once

#include "endovascular_sim/ProcedureStep.h"
#include "procedure/operator.h"

namespace endovascular_sim::nodes
{

/** Record of one procedure step; the remaining fields of the message are not used. */
procedure::StepRecord fromMessage(const ProcedureStep& message);

}  // namespace endovascular_sim::nodes
