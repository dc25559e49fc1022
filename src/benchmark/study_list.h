#pragma once

#include <string>
#include <vector>

#include "benchmark/harness/study.h"

namespace endovascular_sim::benchmark
{

/** Study of the benchmark. */
struct Study
{
  std::string name;  ///< command-line name
  std::string heading;
  std::string summary;  ///< one line for `--help`
  std::vector<TableSpec> tables;
  std::vector<Section> (*run)(const StudyOptions&, const Progress&);
};

/** All studies in the order of their execution. */
const std::vector<Study>& studies();

}  // namespace endovascular_sim::benchmark
