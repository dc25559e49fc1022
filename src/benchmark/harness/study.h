#pragma once

#include <functional>
#include <string>
#include <vector>

#include "benchmark/harness/table.h"

namespace endovascular_sim::benchmark
{

/** Told how far a study has come, 0 to 1, and what it does now. */
using Progress = std::function<void(double, const std::string&)>;

/** What all studies are asked. */
struct StudyOptions
{
  bool quick = false;       ///< fewer and smaller cases: minutes instead of an hour
  std::string vessel_mesh;  ///< path of aortic_arch_tree.obj [mm]; empty: what needs it is left out, and that is said
};

/** One part of a study's report: a paragraph and a table. */
struct Section
{
  std::string name;     ///< of the CSV file, without ending
  std::string heading;  ///< in the report
  std::string text;     ///< Markdown before the table
  Table table;
  std::string plot;       ///< file name of the plot that the section's CSV is drawn into; empty: none
  bool only_csv = false;  ///< too long a table for the report
};

/** The schemes that are compared. */
inline const std::vector<std::string>& schemes()
{
  static const std::vector<std::string> names = {"kkt", "paper", "mixed"};
  return names;
}

}  // namespace endovascular_sim::benchmark
