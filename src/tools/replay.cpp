#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <optional>
#include <sstream>

#include "common/error.h"
#include "common/hash.h"
#include "common/numerics/parallel_for.h"
#include "nodes/session/bag_results.h"
#include "nodes/session/recorded_simulation.h"
#include "nodes/session/session_bag.h"
#include "nodes/session/session_files.h"
#include "results/step_costs_csv.h"
#include "session/cine_files.h"
#include "tools/cine_options.h"
#include "tools/command_line.h"
#include "tools/tool_output.h"

namespace
{

using namespace endovascular_sim;  // NOLINT: a program's main file
using Clock = std::chrono::steady_clock;

constexpr int kDifferent = 1;   ///< exit code: a step differs, or a bag cannot be used
constexpr int kIncomplete = 3;  ///< exit code: all compared steps are equal, but not every step was compared

struct Options
{
  std::vector<std::string> paths;
  std::string out, costs;
  tools::CineOptions cine;
  std::string cine_out;
  bool keep_going = false;
  bool no_pictures = false;
  bool no_plots = false;
  int threads = 0;
};

/** Outcome of a session: exit code, and the lines for both streams. */
struct Outcome
{
  int code = 0;
  std::ostringstream out, err;

  /** Takes over the code of a part; 1 is worse than 3. */
  void add(int part) { code = code == kDifferent || part == kDifferent ? kDifferent : std::max(code, part); }
};

/** Describes the outcome of a comparison. @return exit code */
int report(const nodes::ReplayOutcome& outcome, const nodes::RecordedSimulation& session, const std::string& file,
           Outcome& text)
{
  const auto number = [](std::uint64_t value) { return std::to_string(value); };
  if (outcome.first_different)
    text.err << "replay: step " << *outcome.first_different << " differs: recorded "
             << Hash64::toHex(outcome.recorded_hash) << ", computed " << Hash64::toHex(outcome.computed_hash) << "\n";
  const std::string compared = number(outcome.compared) + " of " + number(outcome.steps) + " steps compared, ";
  const std::string trajectory = "trajectory " + Hash64::toHex(session.simulation().trajectoryHash()) + "\n";
  if (outcome.different > 0 || outcome.incomplete.empty())
  {
    text.out << compared << outcome.different << " different, " << trajectory;
    return outcome.different > 0 ? kDifferent : 0;
  }
  text.out << compared << "all of them equal, but the recording is incomplete, " << trajectory;
  text.err << "replay: " << file << ": " << outcome.incomplete
           << ". Steps after the missing one cannot be computed; use a complete copy of the bag\n";
  return kIncomplete;
}

/** Computes a bag again. @return exit code */
int compare(const std::string& file, const Options& options, bool shows_progress, Outcome& text)
{
  std::optional<results::StepCostsFile> costs;
  if (!options.costs.empty())
    costs.emplace(options.costs);
  const nodes::SessionBag recording = nodes::readSessionBag(file);
  nodes::RecordedSimulation session(recording, file);
  const auto steps = static_cast<double>(recording.steps.size());
  std::uint64_t done = 0;
  Clock::time_point before = Clock::now();
  std::optional<session::CineFiles> cine;
  if (options.cine.isGiven())
  {
    cine.emplace(session.session().world(), options.cine.settings(), session::cineTimeOf(options.cine.interval()),
                 options.cine_out);
    cine->update(session.session());
  }
  const auto after = [&]
  {
    if (cine)
      cine->update(session.session());
    if (costs)
      costs->add(session.simulation(), std::chrono::duration<double>(Clock::now() - before).count());
    if (shows_progress && ++done % 1000 == 0)
      std::fprintf(stderr, "\r%3.0f %% ", 100.0 * static_cast<double>(done) / steps);
    before = Clock::now();
  };
  const nodes::ReplayOutcome outcome = nodes::replay(recording, session, options.keep_going, after);
  if (shows_progress)
    std::fprintf(stderr, "\r");
  if (costs)
    tools::requireWritten(costs->flush(), options.costs);
  if (cine)
    if (const std::string missing = cine->finish(); !missing.empty())
      text.err << "replay: " << missing << "\n";
  return report(outcome, session, file, text);
}

/** Writes the files of a session from its bags. @return exit code */
int writeFiles(const nodes::SessionFiles& session, const std::string& folder, const Options& options, Outcome& text)
{
  const nodes::BagResultFiles files = nodes::writeResults(session.bags, folder, !options.no_pictures);
  for (const std::string& damage : files.damage)
    text.err << "replay: " << session.name << ": the bag is damaged: " << damage << "\n";
  if (files.left_out > 0)
    text.err << "replay: " << session.name << ": " << files.left_out
             << " messages could not be used: damaged, or of another version\n";
  if (!options.no_plots && !tools::runPlots({"results", folder}))
    return kIncomplete;
  text.out << "results in " << folder << (files.verdict.empty() ? "" : ": " + files.verdict) << "\n";
  return files.is_complete ? 0 : kIncomplete;
}

/** Makes the files of a session, if wanted, and computes its bags again. */
void replay(const nodes::SessionFiles& session, const std::string& folder, const Options& options, bool is_single,
            Outcome& text)
{
  bool has_files = false;
  if (!folder.empty())
  {
    text.add(writeFiles(session, folder, options, text));
    has_files = true;
  }
  for (const std::string& bag : session.bags)
    try
    {
      if (!is_single || session.bags.size() > 1)
        text.out << bag << ": ";
      text.add(compare(bag, options, is_single, text));
    }
    catch (const InputError& error)
    {
      if (!is_single || session.bags.size() > 1)
        text.out << "not computed\n";
      text.err << "replay: " << error.what() << "\n";
      text.add(has_files ? kIncomplete : kDifferent);
    }
}

int replayAll(const Options& options)
{
  const std::vector<nodes::SessionFiles> sessions = nodes::sessionsOf(options.paths);
  const bool is_single = sessions.size() == 1;
  int code = 0;
  std::mutex printing;
  parallelFor(sessions.size(), threadCount(options.threads),
              [&](std::size_t k)
              {
                Outcome text;
                std::string folder = options.out;
                if (!folder.empty() && !is_single)
                  folder += "/" + sessions[k].folder;
                try
                {
                  replay(sessions[k], folder, options, is_single, text);
                }
                catch (const InputError& error)  // the other sessions are replayed nevertheless
                {
                  text.err << "replay: " << error.what() << "\n";
                  text.code = kDifferent;
                }
                const std::lock_guard<std::mutex> lock(printing);
                std::cerr << text.err.str() << std::flush;
                std::cout << text.out.str() << std::flush;
                code = code == kDifferent || text.code == kDifferent ? kDifferent : std::max(code, text.code);
              });
  return code;
}

}  // namespace

int main(int argc, char** argv)
{
  Options options;
  tools::CommandLine line(
      "replay",
      "Simulates recorded sessions again from their inputs and compares every step with the recording, bit for bit. "
      "With --out it also makes the files and pages of each session from its bag alone.",
      "The scene, the vessel and the inputs of every step come from the bag. To view a session without computing it "
      "again: "
      "roslaunch endovascular_sim replay.launch bag:=SESSION.bag\n"
      "Exit code: 0 every step of the sessions was compared, all are equal, and all files were written; 1 a step "
      "differs, or a bag cannot be used; 2 wrong arguments; 3 all compared steps are equal, but a recording is "
      "incomplete, damaged, or of another version.");
  line.argument("SESSION", options.paths,
                "bags of the session node, whose index is not needed, or folders of results with all sessions below");
  line.option(
      "--out", options.out, "DIR",
      "writes report.json, metrics.html and the other files of the session node (docs/BAGS.md) into this folder; "
      "of several sessions, into a folder each");
  line.flag("--no-pictures", options.no_pictures, "omits the X-ray pictures of --out");
  line.flag("--no-plots", options.no_plots, "omits the plots of --out");
  line.flag("--keep-going", options.keep_going, "counts all steps that differ instead of ending at the first one");
  line.option("--costs", options.costs, "FILE",
              "writes time, solves and contacts of every step of a single bag as CSV (docs/SIMULATE.md)");
  CLI::Option* cine = options.cine.addTo(line);
  CLI::Option* cine_out =
      line.option("--cine-out", options.cine_out, "DIR", "folder of these frames, which are those of a single bag");
  cine->needs(cine_out);
  cine_out->needs(cine);
  line.option("--threads", options.threads, "N", "sessions at the same time; 0: one per processor, at most 8")
      ->check(CLI::Range(0, 64));
  line.require(
      [&options]() -> std::string
      {
        if (!options.costs.empty() && (options.paths.size() != 1 || std::filesystem::is_directory(options.paths[0])))
          return "--costs takes a single bag";
        if (options.cine.isGiven() && (options.paths.size() != 1 || std::filesystem::is_directory(options.paths[0])))
          return "--cine takes a single bag";
        for (const char* name : {"/report.json", "/session.bag"})
          if (!options.out.empty() && std::filesystem::exists(options.out + name))
            return "--out: " + options.out + " already contains a session; choose another folder";
        return "";
      });
  return line.run(argc, argv, [&] { return replayAll(options); });
}
