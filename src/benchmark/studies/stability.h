#pragma once

#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Tables of stabilityStudy(). */
std::vector<TableSpec> stabilityTables();

/** Hard cases: one factor at a time, a Latin hypercube over all factors, and perturbed states. Every run is good,
 * rejected with a reason, or bad. */
std::vector<Section> stabilityStudy(const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
