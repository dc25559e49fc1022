#pragma once

#include "benchmark/harness/study.h"
#include "benchmark/x_ray/coronary_view.h"

namespace endovascular_sim::benchmark
{

TableSpec motionCostTable();
TableSpec motionErrorTable();

/** Processor time of frames of a patient whose heart beats and who breathes. */
Section motionCost(CoronaryView& view, const StudyOptions& options);

/** Errors of the fast projection of the moved body, and of changes taken from earlier phases. */
Section motionErrors(CoronaryView& view, const StudyOptions& options);

}  // namespace endovascular_sim::benchmark
