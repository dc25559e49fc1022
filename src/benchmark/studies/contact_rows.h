#pragma once

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Adds reference problems with analytically defined walls: force of a pre-curved tip, capstan, insertion into a bend,
 *  buckling in tubes. */
void addContactRows(Section& section, const Progress& progress);

}  // namespace endovascular_sim::benchmark
