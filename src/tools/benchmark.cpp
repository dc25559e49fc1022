#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <new>
#include <string>
#include <vector>

#include "benchmark/study_list.h"
#include "benchmark/tables_page.h"
#include "common/output_file.h"
#include "common/quantities.h"
#include "tools/command_line.h"
#include "tools/tool_output.h"

namespace
{

std::atomic<std::uint64_t> allocation_count{0};

}  // namespace

// Counts the allocations of the program for the speed study. Inlined, GCC 12 reports free() as mismatched with new. The
// sanitizers bring operators of their own.
#ifndef ENDOVASCULAR_SANITIZED
[[gnu::noinline]] void* operator new(std::size_t size)
{
  ++allocation_count;
  if (void* memory = std::malloc(size))
    return memory;
  throw std::bad_alloc();
}

[[gnu::noinline]] void operator delete(void* memory) noexcept
{
  std::free(memory);
}

[[gnu::noinline]] void operator delete(void* memory, std::size_t /*size*/) noexcept
{
  std::free(memory);
}
#endif

namespace
{

using namespace endovascular_sim;             // NOLINT: a program's main file
using namespace endovascular_sim::benchmark;  // NOLINT

struct Options
{
  std::string study;
  std::string out;
  StudyOptions study_options;
};

void addOptions(tools::CommandLine& line, Options& options)
{
  std::vector<std::string> names = {"all"};
  std::string summaries;
  for (const Study& study : studies())
  {
    names.push_back(study.name);
    summaries += study.name + ": " + study.summary + "\n";
  }
  line.argument("STUDY", options.study, summaries + "all: all studies")->check(CLI::IsMember(names));
  line.option("--out", options.out, "DIR",
              "folder for the tables as CSV, the plots and tables.md, whose chapters of the studies run are replaced; "
              "created if "
              "missing")
      ->required();
  line.flag("--quick", options.study_options.quick, "fewer and smaller cases: a few minutes");
  line.quantity("--seconds", options.study_options.seconds, "T", quantities::kDuration,
                "simulated time per scene in force_quality [s]; default: 30, or 3 with --quick")
      ->check(tools::positiveNumber());
  line.option("--vessel-mesh", options.study_options.vessel_mesh, "FILE",
              "aortic_arch_tree.obj [mm]; default: that of ENDOVASCULAR_DATA_DIR")
      ->check(CLI::ExistingFile);
}

/** Absolute path of the vessel mesh: the given one, else that of ENDOVASCULAR_DATA_DIR, else an empty text. */
std::string vesselMesh(const std::string& given)
{
  if (!given.empty())
    return std::filesystem::absolute(given).string();
  const char* folder = std::getenv("ENDOVASCULAR_DATA_DIR");
  const std::filesystem::path mesh = std::filesystem::path(folder != nullptr ? folder : "") / "aortic_arch_tree.obj";
  return folder != nullptr && std::filesystem::exists(mesh) ? std::filesystem::absolute(mesh).string() : "";
}

/** Text of a file; empty without it. */
std::string textOf(const std::filesystem::path& file)
{
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

int run(const Options& options)
{
  const std::filesystem::path out = options.out;
  createFolder(out);
  StudyOptions study_options = options.study_options;
  study_options.vessel_mesh = vesselMesh(study_options.vessel_mesh);
  study_options.allocations = [] { return allocation_count.load(); };
  const bool progress = isatty(STDERR_FILENO);
  const Progress show = [progress](double done, const std::string& text)
  {
    if (progress)
      tools::drawProgress(done, text);
  };
  TablesPage page(textOf(out / "tables.md"));
  const std::string command =
      std::string("rosrun endovascular_sim benchmark ") + options.study + (study_options.quick ? " --quick" : "") +
      (std::isfinite(study_options.seconds) ? " --seconds " + number(study_options.seconds, 6) : "");
  for (const Study& study : studies())
  {
    if (options.study != "all" && options.study != study.name)
      continue;
    std::cerr << study.heading << "\n";
    const std::vector<Section> sections = study.run(study_options, show);
    for (const Section& section : sections)
      tools::writeFile(out / (section.spec.name + ".csv"), section.table.csv());
    page.set(study, command, sections);
    if (progress)
      std::fputc('\n', stderr);
    // Written after every study, so that a failure of a later one loses nothing.
    tools::writeFile(out / "tables.md", page.text(studies()));
  }
  tools::runPlots({"benchmark", out.string()});
  return 0;
}

}  // namespace

int main(int argc, char** argv)
{
  Options options;
  tools::CommandLine line(
      "benchmark",
      "Measures accuracy, stability and speed of the simulation (docs/VALIDATION.md). Requires no ROS master.",
      "Exit code: 0 success; 1 a file cannot be written or a study failed; 2 wrong arguments.");
  addOptions(line, options);
  return line.run(argc, argv, [&options] { return run(options); });
}
