#pragma once

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Reference values other than a tip's position: post-buckling, a ring's and a twisted wire's loss of stability, torque
 *  transmission and its snap, vibration, and the damping of backward Euler, over the number of nodes. */
Section referenceRows(const StudyOptions& options, const Progress& progress);

/** Reference values of a wire at walls given in closed form: force of a pre-curved tip, capstan, buckling in tubes,
 *  insertion into a bend. */
Section contactRows(const StudyOptions& options, const Progress& progress);

}  // namespace endovascular_sim::benchmark
