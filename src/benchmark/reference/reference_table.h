#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "benchmark/harness/table.h"
#include "benchmark/reference/reference_wire.h"

namespace endovascular_sim::benchmark
{

/** Quantity of a scheme with its reference value. */
struct Reference
{
  std::string quantity;
  std::string scheme;
  double exact = 0.0;
  double tolerance =
      NAN;  ///< tolerance of the relative error, of the absolute error for an exact value of 0; NaN: none
};

/** Columns of a table of reference values. */
std::vector<std::string> referenceColumns();

/** Adds a row per number of nodes, coarse to fine, with the observed order and a note beyond the tolerance.
 *  @param ordered false if the error does not depend on the length of the edges: the order is omitted */
void addRows(Table& table, const Reference& reference, const std::vector<int>& counts, bool ordered,
             const std::function<Measured(int)>& measure);

/** Adds a row with the reason for a missing value. */
void addReason(Table& table, const Reference& reference, const std::string& reason);

}  // namespace endovascular_sim::benchmark
