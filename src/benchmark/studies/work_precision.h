#pragma once

#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Error against run time: schemes × nodes × time step (and sampling, in the vessel) on the heavy cantilever of the
 *  published comparison, on a pre-curved tip, and on the wire in aortic_arch_tree.obj. */
std::vector<Section> workPrecisionStudy(const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
