#pragma once

#include "benchmark/harness/study.h"
#include "benchmark/x_ray/coronary_view.h"

namespace endovascular_sim::benchmark
{

TableSpec contrastTable();

/** Processor time of frames with contrast medium, at rest and in a moving patient, over those without. */
Section contrastCost(CoronaryView& view, const StudyOptions& options);

}  // namespace endovascular_sim::benchmark
