#pragma once

#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Hard cases: one factor at a time, a Latin hypercube over all of them, and disturbed states. Every run is good, or
 *  refused with a reason, or bad and named. */
std::vector<Section> stabilityStudy(const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
