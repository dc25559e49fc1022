#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "common/error.h"
#include "common/output_file.h"
#include "common/progress.h"
#include "common/quantities.h"
#include "procedure/perturbation.h"
#include "results/run_result.h"
#include "scene/model/scene.h"
#include "scene/scene_file.h"
#include "session/session.h"
#include "tools/command_line.h"
#include "tools/tool_output.h"

namespace
{

using namespace endovascular_sim;  // NOLINT: a program's main file

constexpr double kCheckPeriod = 0.1;  ///< simulated time between two checks of all nodes [s]

/** Arguments of the command line. */
struct Options
{
  std::string scene;
  std::string out;
  std::string through;
  int runs = 10;
  int first = 1;      ///< seed of the first run
  int at_least = -1;  ///< required successful runs; negative: all
  procedure::Spread spread;
  std::vector<std::string> overrides;
};

void addOptions(tools::CommandLine& line, Options& options)
{
  line.argument("SCENE.yaml", options.scene, "scene with a procedure");
  line.option("--out", options.out, "DIR", "folder for study.csv and, in DIR/SEED, the metrics of each run")
      ->required();
  line.option("--runs", options.runs, "N", "number of runs [10]")->check(CLI::Range(1, 1000000));
  line.option("--first", options.first, "N",
              "seed of the first run, each further run takes the next one; seed 0 is the "
              "scene without variation [1]")
      ->check(CLI::Range(0, 1000000));
  line.option("--through", options.through, "PHASE", "ends every run after this phase of the procedure");
  line.option("--at-least", options.at_least, "N", "number of successful runs required for exit code 0 [all]")
      ->check(CLI::Range(0, 1000000));
  line.quantity("--insertion", options.spread.insertion, "M", quantities::kInsertion,
                "half range of the initial insertion [0.005 m]");
  line.quantity("--rotation", options.spread.rotation, "RAD", quantities::kRotation,
                "half range of the initial rotation [0.5 rad]");
  line.quantity("--speed", options.spread.speed, "SHARE", quantities::kFraction,
                "half range of the speed, as a share of it, below 1 [0.2]");
  line.overrides(options.overrides, "replaces a value of the scene");
  line.require([&options] { return options.spread.speed < 1.0 ? "" : "--speed requires a share below 1"; });
}

/** Result of one run. */
struct Outcome
{
  double seconds = 0.0;      ///< simulated time at its end [s]
  int nodes_outside = 0;     ///< largest number of nodes outside of the vessel
  double penetration = 0.0;  ///< largest one of a surface beyond the wall [m]
  std::string failure;       ///< reason; empty after success
};

/** Runs the procedure from the beginning of the session, and writes its metrics. */
Outcome run(session::Session& session, const std::string& folder)
{
  while (session.step(1000) > 0)
  {
  }
  session.finish(folder, session::RecordFiles::kMetrics);
  const results::RunResult& result = session.record().result();
  const procedure::Operator& scripted = *session.scriptedOperator();
  Outcome outcome{session.observe().time(), result.nodesOutside(), result.worstPenetration(), scripted.failure()};
  if (scripted.progress() == procedure::Progress::kRunning)
    outcome.failure = "not finished within the scene's duration";
  else if (outcome.nodes_outside > 0)
    outcome.failure = "nodes outside of the vessel";
  return outcome;
}

/** Prints warnings and notes of a vessel on the error stream. */
void printVessel(const vessel::Vessel& vessel)
{
  tools::printWarnings("procedure_study", vessel.warnings);
  tools::printNotes(vessel.source, vessel.notes);
}

int study(const Options& options)
{
  scene::Scene scene = scene::loadScene(options.scene, options.overrides);
  tools::printWarnings("procedure_study", scene.warnings);
  if (!scene.procedure)
    throw InputError(scene.file, "procedure", "missing; give procedure: FILE");
  if (!options.through.empty())
    scene = procedure::endingWith(std::move(scene), options.through);
  session::SessionSettings settings;
  settings.results = true;
  settings.outside_check = kCheckPeriod;
  settings.spread = options.spread;
  session::Session session(session::World::make(std::move(scene), progressOnErrorStream(), printVessel), settings);
  createFolder(options.out);
  std::ofstream table = tools::openFile(options.out + "/study.csv");
  table << "seed,success,time,nodes_outside,penetration,why\n";
  int succeeded = 0;
  for (int k = 0; k < options.runs; ++k)
  {
    const auto seed = static_cast<std::uint64_t>(options.first) + static_cast<std::uint64_t>(k);
    session.reset(seed);
    const Outcome outcome = run(session, options.out + "/" + std::to_string(seed));
    const bool is_success = outcome.failure.empty();
    succeeded += is_success ? 1 : 0;
    table << seed << "," << is_success << "," << outcome.seconds << "," << outcome.nodes_outside << ","
          << outcome.penetration << ",\"" << outcome.failure << "\"\n"
          << std::flush;
    std::printf("start %lu: %s after %.1f s, %d nodes outside, %.4f mm beyond the wall\n",
                static_cast<unsigned long>(seed), is_success ? "success" : ("failed: " + outcome.failure).c_str(),
                outcome.seconds, outcome.nodes_outside, 1e3 * outcome.penetration);
    std::fflush(stdout);
  }
  tools::requireWritten(static_cast<bool>(table), options.out + "/study.csv");
  std::printf("%d of %d\n", succeeded, options.runs);
  return succeeded >= (options.at_least >= 0 ? options.at_least : options.runs) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv)
{
  Options options;
  tools::CommandLine line(
      "procedure_study",
      "Runs a scene's procedure from several starts, which vary in insertion, rotation and speed, and "
      "counts the successful runs.",
      "Exit code: 0 enough runs succeeded; 1 too few succeeded or the scene was rejected; 2 wrong "
      "arguments.");
  addOptions(line, options);
  return line.run(argc, argv, [&options] { return study(options); });
}
