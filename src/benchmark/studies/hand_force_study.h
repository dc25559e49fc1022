#pragma once

#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** The force at the hand: against insertion as in the charts of Li et al., over the number of nodes, and how smooth it
 *  is. */
std::vector<Section> handForceStudy(const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
