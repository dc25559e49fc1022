#pragma once

#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

std::vector<TableSpec> jamTables();

/** Wire that is pushed through a catheter against a closed end: forces before a hand slips against those in a rigid
 *  tube, and largest forces. Quick: grips up to 5 N. */
std::vector<Section> jamStudy(const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
