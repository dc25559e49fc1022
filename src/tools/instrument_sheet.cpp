#include <cmath>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "benchmark/sheet/data_sheet.h"
#include "common/output_file.h"
#include "common/quantities.h"
#include "common/text/format.h"
#include "scene/instrument_library.h"
#include "tools/command_line.h"
#include "tools/tool_output.h"

namespace
{
namespace fs = std::filesystem;
using namespace endovascular_sim;             // NOLINT: a program's main file
using namespace endovascular_sim::benchmark;  // NOLINT

struct Options
{
  std::string instrument;
  std::vector<std::string> overrides;
  fs::path out = ".";
  SpecimenChoice choice;
};

/** Path of an instrument's file: a file, or the name of one in the library. */
std::string fileOf(const std::string& word)
{
  return fs::is_regular_file(word) || fs::path(word).has_extension() ? word : scene::libraryInstrument(word);
}

std::string commandOf(const Options& options)
{
  std::string command = "rosrun endovascular_sim instrument_sheet " + options.instrument;
  for (const std::string& change : options.overrides)
    command += " --set '" + change + "'";
  if (!std::isnan(options.choice.from_tip))
    command += " --from-tip " + shortNumber(options.choice.from_tip);
  return command;
}

void print(const DataSheet& sheet)
{
  for (const BenchTest& test : sheet.tests)
  {
    std::cout << test.heading << "\n";
    for (const SheetRow& row : test.rows)
    {
      std::cout << "  " << row.quantity << ": " << shortNumber(row.value, 4) << " " << row.unit;
      if (!std::isnan(row.reference))
        std::cout << ", reference " << shortNumber(row.reference, 4) << " " << row.unit;
      std::cout << "\n";
    }
  }
}

int run(const Options& options)
{
  const std::string file = fileOf(options.instrument);
  std::vector<std::string> warnings;
  const instrument::Instrument instrument = scene::loadInstrument(file, options.overrides, &warnings);
  tools::printWarnings("instrument_sheet", warnings);
  DataSheet sheet;
  sheet.title = fs::path(file).stem().string();
  sheet.command = commandOf(options);
  createFolder(options.out.string());
  const fs::path stem = options.out / (sheet.title + "_sheet");
  tools::requireWritable(stem.string() + ".html");
  sheet.tests = benchTests(instrument, options.choice);
  sheet.outline = outlineOf(instrument);
  tools::writeFile(stem.string() + ".html", htmlOf(sheet));
  tools::writeFile(stem.string() + ".csv", csvOf(sheet));
  tools::writeFile(stem.string() + ".json", jsonOf(sheet));
  print(sheet);
  return 0;
}

void addOptions(tools::CommandLine& line, Options& options)
{
  line.argument("INSTRUMENT", options.instrument,
                "YAML file, or the name of one in config/instruments, e.g. guidewire_035_stiff");
  line.option("--out", options.out, "DIR",
              "folder for INSTRUMENT_sheet.html, .csv and .json; created if missing; default: the present one");
  line.quantity("--from-tip", options.choice.from_tip, "L", quantities::kFromTip,
                "distance from the tip to the section of the shaft that is tested [m]; default: the middle of the "
                "longest section")
      ->check(tools::nonNegativeNumber());
  line.overrides(options.overrides, "replaces a value of the instrument, e.g. --set sections.0.bending_stiffness=3e-4");
}

}  // namespace

int main(int argc, char** argv)
{
  Options options;
  tools::CommandLine line(
      "instrument_sheet",
      "Runs the bench tests of a data sheet on an instrument: three-point bending, torque response, tip load of "
      "guidewires, pushability, trackability (docs/BENCH_TESTS.md). Prints the results and draws a sheet with "
      "references and curves.",
      "Exit code: 0 success; 1 the instrument was rejected or a test failed (the reason is on the error stream); 2 "
      "wrong arguments.");
  addOptions(line, options);
  return line.run(argc, argv, [&options] { return run(options); });
}
