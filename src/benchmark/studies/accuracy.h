#pragma once

#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Tables of accuracyStudy(). */
std::vector<TableSpec> accuracyTables();

/** Errors of every scheme against reference values over the number of nodes, with the observed order of convergence. A
 *  scheme that rejects a case is listed with the reason. */
std::vector<Section> accuracyStudy(const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
