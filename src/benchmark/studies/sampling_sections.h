#pragma once

#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** The study of adaptive sampling as tables: every run of every case, and the acceptance measures. */
std::vector<Section> samplingSections(const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
