#pragma once

#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Tables of xRayStudy(). */
std::vector<TableSpec> xRayTables();

/** Processor time of X-ray frames: at rest, after a movement, over pixels and triangles. */
std::vector<Section> xRayStudy(const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
