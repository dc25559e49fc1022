#pragma once

#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Tables of reversalStudy(). */
std::vector<TableSpec> reversalTables();

/** Torque at the hand after a reversal of rotation, over the speed and the time step. */
std::vector<Section> reversalStudy(const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
