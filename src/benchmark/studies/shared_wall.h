#pragma once

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Table of sharedWallCost(). */
TableSpec sharedWallTable();

/** Memory and processor time of a further simulation in the demonstration's anatomy, with a shared and with its own
 *  wall model. */
Section sharedWallCost(const Progress& progress);

}  // namespace endovascular_sim::benchmark
