#pragma once

#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Tables of workPrecisionStudy(). */
std::vector<TableSpec> workPrecisionTables();

/** Error over run time for schemes × nodes × time steps (and samplings, in the vessel): the heavy cantilever of the
 *  published comparison, a pre-curved wire, and a wire in aortic_arch_tree.obj. */
std::vector<Section> workPrecisionStudy(const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
