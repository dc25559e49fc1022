#pragma once

#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Tables of handForceStudy(). */
std::vector<TableSpec> handForceTables();

/** Force at the hand: over insertion as in the charts of the paper, over the number of nodes, and its noise. */
std::vector<Section> handForceStudy(const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
