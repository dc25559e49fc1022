#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Time per step, phase by phase, over the number of nodes: the table of the paper, and on to 5000 nodes.
 *  @param allocations counts the allocations of the process so far; empty: they are not counted */
std::vector<Section> speedStudy(const StudyOptions& options, const Progress& progress,
                                const std::function<std::uint64_t()>& allocations);

}  // namespace endovascular_sim::benchmark
