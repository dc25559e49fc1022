#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>

#include "benchmark/fuzz/fuzz_record.h"
#include "common/error.h"
#include "common/output_file.h"
#include "tools/command_line.h"
#include "tools/tool_output.h"

namespace
{

using namespace endovascular_sim;             // NOLINT: a program's main file
using namespace endovascular_sim::benchmark;  // NOLINT
using Clock = std::chrono::steady_clock;

constexpr double kSaveInterval = 10.0;  // wall-clock time between saved states [s]

volatile std::sig_atomic_t interrupted = 0;

struct Options
{
  std::string out;
  std::uint64_t steps = 1000000;
  FuzzSettings settings;
  bool resume = false;
  std::optional<std::uint64_t> episode;  ///< number of a single episode
  std::vector<std::string> meshes;
};

void addOptions(tools::CommandLine& line, Options& options)
{
  line.option("--out", options.out, "DIR",
              "folder for leak_fuzz.json (result and state), leak_fuzz.csv (worst episodes) and leak_fuzz.md");
  line.option("--steps", options.steps, "N", "total number of steps [1000000]");
  line.option("--seed", options.settings.seed, "S", "seed of the random choices [1]");
  line.flag("--smooth", options.settings.smooth, "smooth walls (vessel.wall: smooth) in place of facets");
  line.flag("--coaxial", options.settings.coaxial, "a wire in a catheter, each with a hand of its own");
  line.flag("--moving", options.settings.moving, "the vessel moves by 10 mm at 90 beats per minute");
  line.flag("--resume", options.resume, "continues from DIR/leak_fuzz.json");
  line.option("--episode", options.episode, "K", "runs this episode only, prints its result and writes no file");
  line.repeated("--mesh", options.meshes, "FILE",
                "mesh to fuzz in [mm or m]; default: all meshes of ENDOVASCULAR_DATA_DIR that can be read");
  line.overrides(options.settings.overrides, "replaces a value of every scene, e.g. --set solver.max_newton=2");
  line.require([&options] { return options.out.empty() && !options.episode ? "--out is required" : ""; });
}

/** Meshes of ENDOVASCULAR_DATA_DIR, sorted by name. */
std::vector<std::string> meshesOfDataFolder()
{
  std::vector<std::string> files;
  const char* folder = std::getenv("ENDOVASCULAR_DATA_DIR");
  if (folder == nullptr || !std::filesystem::is_directory(folder))
    return files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
  {
    const std::string ending = entry.path().extension().string();
    if (ending == ".obj" || ending == ".stl" || ending == ".ply")
      files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/** Replaces a file by way of a temporary one, so that an interruption leaves the earlier file intact. */
void replaceFile(const std::filesystem::path& path, const std::string& text)
{
  const std::filesystem::path part = path.string() + ".part";
  tools::writeFile(part, text);
  std::error_code reason;
  std::filesystem::rename(part, path, reason);
  if (reason)
    throw InputError(path.string(), "", "cannot be replaced (" + reason.message() + "); give another folder");
}

/** Command that reproduces the episodes. */
std::string reproduction(const Options& options)
{
  std::string command = "rosrun endovascular_sim leak_fuzz --seed " + std::to_string(options.settings.seed);
  if (options.settings.smooth)
    command += " --smooth";
  if (options.settings.coaxial)
    command += " --coaxial";
  if (options.settings.moving)
    command += " --moving";
  for (const std::string& mesh : options.meshes)
    command += " --mesh " + mesh;
  for (const std::string& value : options.settings.overrides)
    command += " --set " + value;
  return command;
}

void save(const Options& options, const FuzzRecord& record, const FuzzVessels& vessels)
{
  const std::filesystem::path out = options.out;
  replaceFile(out / "leak_fuzz.json", record.json());
  replaceFile(out / "leak_fuzz.csv", record.csv());
  replaceFile(out / "leak_fuzz.md", record.markdown(reproduction(options), vessels.skipped()));
}

void drawProgress(const FuzzRecord& record, std::uint64_t steps, double seconds, std::uint64_t begin)
{
  std::fprintf(stderr, "\r\033[K%llu of %llu steps, %.0f per s; %llu escapes, %llu not finite, deepest %.4f mm",
               static_cast<unsigned long long>(record.steps()), static_cast<unsigned long long>(steps),
               static_cast<double>(record.steps() - begin) / std::max(1e-3, seconds),
               static_cast<unsigned long long>(record.escapes()), static_cast<unsigned long long>(record.notFinite()),
               1e3 * record.depth());
}

int runOne(const Options& options, FuzzVessels& vessels)
{
  FuzzRecord record(options.settings, vessels.kinds());
  record.add(fuzzEpisode(vessels, options.settings, *options.episode));
  std::cout << record.json();
  return record.good() ? 0 : 1;
}

int run(const Options& options)
{
  FuzzVessels vessels(options.meshes.empty() ? meshesOfDataFolder() : options.meshes, options.settings.smooth);
  for (const std::string& reason : vessels.skipped())
    std::cerr << "leak_fuzz: skipped " << reason << "\n";
  if (options.episode)
    return runOne(options, vessels);
  createFolder(options.out);
  FuzzRecord record(options.settings, vessels.kinds());
  const std::string state = options.out + "/leak_fuzz.json";
  if (options.resume)
  {
    std::ifstream stream(state);
    if (!stream)
      throw InputError(state, "", "missing; omit --resume to start");
    record.resume(std::string(std::istreambuf_iterator<char>(stream), {}), state);
  }
  std::signal(SIGINT, [](int) { interrupted = 1; });
  std::signal(SIGTERM, [](int) { interrupted = 1; });
  const bool progress = isatty(STDERR_FILENO);
  const std::uint64_t begin_steps = record.steps();
  const Clock::time_point begin = Clock::now();
  Clock::time_point saved = begin;
  while (record.steps() < options.steps && interrupted == 0)
  {
    record.add(fuzzEpisode(vessels, options.settings, record.nextEpisode()));
    const Clock::time_point now = Clock::now();
    if (progress)
      drawProgress(record, options.steps, std::chrono::duration<double>(now - begin).count(), begin_steps);
    if (std::chrono::duration<double>(now - saved).count() < kSaveInterval)
      continue;
    save(options, record, vessels);
    saved = now;
  }
  if (progress)
    std::fputc('\n', stderr);
  save(options, record, vessels);
  std::cout << record.markdown(reproduction(options), vessels.skipped());
  return record.good() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv)
{
  Options options;
  tools::CommandLine line(
      "leak_fuzz",
      "Pushes, pulls and turns random wires in many vessels and checks that no part of a wire leaves the vessel. "
      "Requires no "
      "ROS master.",
      "Channels, bifurcations and the generated anatomy are always included. docs/CONTACT.md describes the checks.\n"
      "Exit code: 0 no wire left its vessel; 1 a wire left or a file cannot be written; 2 wrong arguments.");
  addOptions(line, options);
  return line.run(argc, argv, [&options] { return run(options); });
}
