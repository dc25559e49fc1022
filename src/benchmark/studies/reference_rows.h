#pragma once

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Adds reference values without contact over the number of nodes: post-buckling, loss of stability of a ring and of a
 *  twisted wire, torque transmission with snap-through, vibration, and the damping of backward Euler. */
void addReferenceRows(Section& section, const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
