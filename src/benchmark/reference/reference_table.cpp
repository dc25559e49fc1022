#include "benchmark/reference/reference_table.h"

namespace endovascular_sim::benchmark
{

std::vector<std::string> referenceColumns()
{
  return {"quantity",       "scheme",    "nodes", "value",       "exact",
          "relative error", "tolerance", "order", "µs per step", "note"};
}

void addRows(Table& table, const Reference& reference, const std::vector<int>& counts, bool ordered,
             const std::function<Measured(int)>& measure)
{
  double previous_error = NAN;
  double previous_nodes = NAN;
  for (int nodes : counts)
  {
    const Measured measured = measure(nodes);
    const double scale = reference.exact != 0.0 ? std::abs(reference.exact) : 1.0;
    const double error = std::abs(measured.value - reference.exact) / scale;
    const double order = ordered ? std::log(previous_error / error) / std::log(nodes / previous_nodes) : NAN;
    std::string note = measured.note;
    if (!(error <= reference.tolerance) && !std::isnan(reference.tolerance))
      note.insert(0, note.empty() ? "beyond the tolerance" : "beyond the tolerance: ");
    table.add({reference.quantity, reference.scheme, std::to_string(nodes), number(measured.value, 8),
               number(reference.exact, 8), number(error, 2), number(reference.tolerance, 2), number(order, 2),
               measured.step_us > 0.0 ? number(measured.step_us) : "", note});
    previous_error = error;
    previous_nodes = nodes;
  }
}

void addReason(Table& table, const Reference& reference, const std::string& reason)
{
  table.add({reference.quantity, reference.scheme, "", "", number(reference.exact, 8), "",
             number(reference.tolerance, 2), "", "", reason});
}

}  // namespace endovascular_sim::benchmark
