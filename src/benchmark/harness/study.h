#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "benchmark/harness/table.h"

namespace endovascular_sim::benchmark
{

/** Callback for the progress of a study: completed share, 0 to 1, and the present case. */
using Progress = std::function<void(double, const std::string&)>;

/** Options of all studies. */
struct StudyOptions
{
  bool quick = false;                                         ///< fewer and smaller cases: minutes instead of an hour
  double seconds = std::numeric_limits<double>::quiet_NaN();  ///< simulated time per scene; NaN: of the study [s]
  std::string vessel_mesh;  ///< path of aortic_arch_tree.obj [mm]; empty: cases that need it are omitted and named
  std::function<std::uint64_t()> allocations;  ///< number of allocations of the process so far; empty: not counted
};

/** Declaration of a table of a study, known before the study runs. */
struct TableSpec
{
  std::string name;     ///< name of the CSV file without extension
  std::string heading;  ///< heading in tables.md
  std::vector<std::string> columns;
  std::string plot;  ///< file name of the plot drawn from the CSV file; empty: none
};

/** Table of a study with its description. */
struct Section
{
  /** @param tables tables of the study
   *  @param name name of one of them */
  Section(const std::vector<TableSpec>& tables, const std::string& name)
    : spec(*std::find_if(tables.begin(), tables.end(), [&name](const TableSpec& t) { return t.name == name; })),
      table(spec.columns)
  {
  }

  TableSpec spec;
  std::string text;  ///< description in Markdown: method, conditions, results derived from the table
  Table table;
};

/** Simulation schemes compared by the studies. */
inline const std::vector<std::string>& schemes()
{
  static const std::vector<std::string> names = {"kkt", "paper", "mixed"};
  return names;
}

}  // namespace endovascular_sim::benchmark
