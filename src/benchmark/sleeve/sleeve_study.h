#pragma once

#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Tables of sleeveStudy(). */
std::vector<TableSpec> sleeveTables();

/** Force on the hand that pushes a rod through the introducer towards a pin, against the exact elastica. */
std::vector<Section> sleeveStudy(const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
