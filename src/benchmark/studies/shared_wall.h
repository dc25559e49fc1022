#pragma once

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Declaration of the table of sharedWallCost(). */
TableSpec sharedWallTable();

/** Memory and processor time of a further session of a scene, with a shared world and with its own; of its reset and of
 *  loading a state, without and with an inflated balloon. */
Section sharedWallCost(const Progress& progress);

}  // namespace endovascular_sim::benchmark
