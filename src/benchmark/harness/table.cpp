#include "benchmark/harness/table.h"

#include <cmath>

#include "common/text/format.h"

namespace endovascular_sim::benchmark
{
namespace
{

std::string joined(const std::vector<std::string>& cells, const std::string& separator)
{
  std::string line;
  for (std::size_t k = 0; k < cells.size(); ++k)
    line += (k > 0 ? separator : "") + cells[k];
  return line;
}

/** Cells in CSV syntax: quoted if they contain a comma. */
std::vector<std::string> quoted(std::vector<std::string> cells)
{
  for (std::string& cell : cells)
    if (cell.find(',') != std::string::npos)
      cell.insert(0, 1, '"').push_back('"');
  return cells;
}

}  // namespace

std::string Table::csv() const
{
  std::string text = joined(quoted(columns_), ",") + "\n";
  for (const std::vector<std::string>& row : rows_)
    text += joined(quoted(row), ",") + "\n";
  return text;
}

std::string Table::markdown() const
{
  std::string text =
      "| " + joined(columns_, " | ") + " |\n|" + joined(std::vector<std::string>(columns_.size(), "---"), "|") + "|\n";
  for (const std::vector<std::string>& row : rows_)
    text += "| " + joined(row, " | ") + " |\n";
  return text;
}

std::string number(double value, int digits)
{
  return std::isnan(value) ? "" : shortNumber(value, digits);
}

}  // namespace endovascular_sim::benchmark
