#pragma once

#include <string>
#include <vector>

#include "benchmark/sheet/bench_tests.h"

namespace endovascular_sim::benchmark
{

/** Results of the bench tests of one instrument. */
struct DataSheet
{
  std::string title;    ///< name of the instrument
  std::string command;  ///< command that makes the sheet
  std::string outline;  ///< kind, size and length in words
  std::vector<BenchTest> tests;
};

/** Kind, diameter in inches or French, length and lumen of an instrument in words. */
std::string outlineOf(const instrument::Instrument& instrument);

/** The sheet as one HTML page with its curves. */
std::string htmlOf(const DataSheet& sheet);

/** Rows: test, quantity, value, unit, reference, deviation, method. The deviation is relative, or in the unit for
 *  references near zero. */
std::string csvOf(const DataSheet& sheet);

/** The same as JSON, with the conditions of the tests; null without a reference. */
std::string jsonOf(const DataSheet& sheet);

}  // namespace endovascular_sim::benchmark
