#pragma once

#include "benchmark/study.h"

namespace endovascular_sim::benchmark
{

/** Reference values other than a tip's position: post-buckling, a ring's loss of stability, torque transmission and its
 *  snap, vibration, and the damping of backward Euler, over the number of nodes. */
Section referenceRows(const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
