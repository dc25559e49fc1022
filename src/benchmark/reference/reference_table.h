#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "benchmark/harness/table.h"
#include "benchmark/reference/reference_wire.h"

namespace endovascular_sim::benchmark
{

/** A quantity with its reference value, as a scheme finds it. */
struct Reference
{
  std::string quantity;
  std::string scheme;
  double exact = 0.0;
  double tolerance = NAN;  ///< of the relative error, absolute where the exact value is 0; NaN: none is set
};

/** An empty table of references. */
Table referenceTable();

/** Adds a row per number of nodes, coarse to fine, with the observed order; a row beyond its tolerance says so.
 *  @param ordered false where the error is not that of the edges' length: no order is given */
void addRows(Table& table, const Reference& reference, const std::vector<int>& counts, bool ordered,
             const std::function<Measured(int)>& measure);

/** Adds a row that says why there is no value. */
void addReason(Table& table, const Reference& reference, const std::string& reason);

}  // namespace endovascular_sim::benchmark
