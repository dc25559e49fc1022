#pragma once

#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Errors against reference values, over the number of nodes, with the observed order of convergence, for every scheme.
 *  A scheme that refuses a case is listed with its reason. */
std::vector<Section> accuracyStudy(const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
