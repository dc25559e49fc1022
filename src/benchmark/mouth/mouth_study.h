#pragma once

#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

std::vector<TableSpec> mouthTables();

/** Force at the hand while a curved instrument passes the introducer's mouth, against a quasi-static reference. */
std::vector<Section> mouthStudy(const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
