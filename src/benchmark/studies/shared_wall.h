#pragma once

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Declaration of the table of sharedWallCost(). */
TableSpec sharedWallTable();

/** Memory and processor time of a further simulation in the anatomy of the scene `demo`, with a shared and with its own
 *  wall model. */
Section sharedWallCost(const Progress& progress);

}  // namespace endovascular_sim::benchmark
