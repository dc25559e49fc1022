#pragma once

#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Tables of speedStudy(). */
std::vector<TableSpec> speedTables();

/** Time per step over the number of nodes: by phase for the nodes of the table of the paper, in total up to 5000 nodes.
 */
std::vector<Section> speedStudy(const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
