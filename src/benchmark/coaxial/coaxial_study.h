#pragma once

#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Tables of coaxialStudy(). */
std::vector<TableSpec> coaxialTables();

/** Force on a wire that slides in a catheter, against the same wire in a rigid tube of the catheter's bore and path. */
std::vector<Section> coaxialStudy(const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
