#pragma once

#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Tables of samplingSections(). */
std::vector<TableSpec> samplingTables();

/** Study of adaptive sampling: every run of every case, and the acceptance measures. */
std::vector<Section> samplingSections(const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
