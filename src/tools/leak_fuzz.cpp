#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "benchmark/fuzz/fuzz_record.h"
#include "common/error.h"

namespace
{

using namespace endovascular_sim;             // NOLINT: a program's main file
using namespace endovascular_sim::benchmark;  // NOLINT
using Clock = std::chrono::steady_clock;

constexpr auto kUsage =
    R"(Pushes, pulls and turns random wires in many vessels and looks whether any part of them leaves. Needs no ROS master.

usage: leak_fuzz --out DIR [--steps N] [--seed S] [--resume] [--episode K] [--mesh FILE ...] [--set key.path=value ...]

  --out DIR             writes leak_fuzz.json (result and state), leak_fuzz.csv (worst episodes) and leak_fuzz.md there
  --steps N             stops after N steps in all, default 1000000
  --seed S              of the random choices, default 1
  --resume              goes on from DIR/leak_fuzz.json
  --episode K           runs this episode alone, tells what became of it and writes nothing
  --mesh FILE           a mesh to fuzz in [mm or m], may be repeated; default: all of ENDOVASCULAR_DATA_DIR that load
  --set key.path=value  replaces a value of every scene, e.g. --set solver.max_iterations=2
  --help                prints this

Channels, bifurcations and the generated anatomy are always fuzzed. docs/CONTACT.md tells what is checked.

exit code: 0 nothing left, 1 something did or a file cannot be written, 2 wrong use
)";

constexpr double kSaveEvery = 10.0;  // s

volatile std::sig_atomic_t interrupted = 0;

struct Options
{
  std::string out;
  std::uint64_t steps = 1000000;
  FuzzSettings settings;
  bool resume = false;
  bool one = false;
  std::uint64_t episode = 0;
  std::vector<std::string> meshes;
};

int wrongUse(const std::string& reason)
{
  std::cerr << "leak_fuzz: " << reason << "\n\n" << kUsage;
  return 2;
}

bool parseCount(const std::string& text, std::uint64_t& count)
{
  if (text.empty() || text.size() > 18 || text.find_first_not_of("0123456789") != std::string::npos)
    return false;
  count = std::stoull(text);
  return true;
}

/** @return −1 to go on, else the exit code */
int parse(int argc, char** argv, Options& options)
{
  for (int i = 1; i < argc; ++i)
  {
    const std::string word = argv[i];
    if (word == "--help" || word == "-h")
    {
      std::cout << kUsage;
      return 0;
    }
    if (word == "--resume")
    {
      options.resume = true;
      continue;
    }
    if (i + 1 >= argc)
      return wrongUse("cannot use '" + word + "'");
    const std::string value = argv[++i];
    std::uint64_t* count = word == "--steps"     ? &options.steps
                           : word == "--seed"    ? &options.settings.seed
                           : word == "--episode" ? &options.episode
                                                 : nullptr;
    if (count != nullptr && !parseCount(value, *count))
      return wrongUse(word + " takes a whole number, not '" + value + "'");
    options.one = options.one || word == "--episode";
    if (word == "--out")
      options.out = value;
    else if (word == "--mesh")
      options.meshes.push_back(value);
    else if (word == "--set")
      options.settings.overrides.push_back(value);
    else if (count == nullptr)
      return wrongUse("cannot use '" + word + "'");
  }
  return options.out.empty() && !options.one ? wrongUse("--out is needed") : -1;
}

/** Meshes of ENDOVASCULAR_DATA_DIR in the order of their names. */
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

void writeFile(const std::filesystem::path& path, const std::string& text)
{
  const std::filesystem::path part = path.string() + ".part";
  std::ofstream stream(part);
  if (!(stream << text) || !stream.flush())
    throw InputError(path.string(), "", "cannot be written; check the folder's permissions and the disk's free space");
  stream.close();
  std::filesystem::rename(part, path);
}

std::string reproduction(const Options& options)
{
  std::string command = "rosrun endovascular_sim leak_fuzz --seed " + std::to_string(options.settings.seed);
  for (const std::string& mesh : options.meshes)
    command += " --mesh " + mesh;
  for (const std::string& value : options.settings.overrides)
    command += " --set " + value;
  return command;
}

void save(const Options& options, const FuzzRecord& record, const FuzzVessels& vessels)
{
  const std::filesystem::path out = options.out;
  writeFile(out / "leak_fuzz.json", record.json());
  writeFile(out / "leak_fuzz.csv", record.csv());
  writeFile(out / "leak_fuzz.md", record.markdown(reproduction(options), vessels.skipped()));
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
  record.add(fuzzEpisode(vessels, options.settings, options.episode));
  std::cout << record.json();
  return record.good() ? 0 : 1;
}

int run(const Options& options)
{
  FuzzVessels vessels(options.meshes);
  for (const std::string& reason : vessels.skipped())
    std::cerr << "leak_fuzz: left out " << reason << "\n";
  if (options.one)
    return runOne(options, vessels);
  std::filesystem::create_directories(options.out);
  FuzzRecord record(options.settings, vessels.kinds());
  const std::string state = options.out + "/leak_fuzz.json";
  if (options.resume)
  {
    std::ifstream stream(state);
    if (!stream)
      throw InputError(state, "", "is not there; leave --resume out to start");
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
    if (std::chrono::duration<double>(now - saved).count() < kSaveEvery)
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
  const int code = parse(argc, argv, options);
  if (code >= 0)
    return code;
  try
  {
    if (options.meshes.empty())
      options.meshes = meshesOfDataFolder();
    return run(options);
  }
  catch (const std::exception& error)
  {
    std::cerr << "leak_fuzz: " << error.what() << "\n";
    return 1;
  }
}
