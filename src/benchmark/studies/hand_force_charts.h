#pragma once

#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Charts of the force at the hand as in Fig. 10 of the paper, their means, and the orderings that the paper states: by
 * the force at the hand with the default scheme, and by the impulse force of the paper, its equation (6), with the
 * scheme `paper`.
 *  @param specs tables of the study; those of the charts are filled */
std::vector<Section> chartSections(const std::vector<TableSpec>& specs, const Progress& progress);

}  // namespace endovascular_sim::benchmark
