#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "common/error.h"
#include "common/output_file.h"
#include "common/progress.h"
#include "common/quantities.h"
#include "contact/detector.h"
#include "procedure/perturbation.h"
#include "results/run_result.h"
#include "results/session_run.h"
#include "scene/model/scene.h"
#include "scene/scene_file.h"
#include "scene/scene_vessel.h"
#include "simulation/local_deformable_wall.h"
#include "simulation/simulation.h"
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

/** Runs the procedure once and writes its metrics.
 *  @param model wall of the vessel, shared by all runs */
Outcome run(const scene::Scene& scene, const vessel::Vessel& vessel,
            const std::shared_ptr<const contact::WallModel>& model, const std::string& folder)
{
  const scene::EntryPose entry = scene::resolveStart(scene, vessel);
  contact::Detector wall(model, scene::wallLaw(*scene.vessel));
  results::SessionRun session(scene, vessel, entry.position);
  const std::unique_ptr<simulation::LocalDeformableWall> moving_wall =
      simulation::makeLocalDeformableWall(scene, vessel, wall);
  simulation::Simulation simulation(scene, entry, &wall, &vessel.centreline, moving_wall.get());
  std::vector<simulation::WallContact> contacts;
  const auto steps = static_cast<std::uint64_t>(scene.duration / scene.solver.time_step);
  const auto check_interval = static_cast<std::uint64_t>(std::max(1.0, kCheckPeriod / scene.solver.time_step));
  results::RunResult result(scene, 0, 0);
  while (simulation.steps() < steps && !session.isFinished())
  {
    simulation.stepAll(session.commands(simulation));
    simulation::wallContacts(simulation, contacts);
    session.addStep(simulation, contacts);
    result.addStep(simulation, 0.0);
    if (simulation.steps() % check_interval == 0)
      result.checkOutside(simulation, wall);
  }
  createFolder(folder);
  session.finish(simulation, moving_wall ? &moving_wall->opening().mesh() : nullptr);
  session.write(folder);
  Outcome outcome{simulation.time(), result.nodesOutside(), result.worstPenetration(),
                  session.scriptedOperator()->failure()};
  if (session.scriptedOperator()->progress() == procedure::Progress::kRunning)
    outcome.failure = "not finished within the scene's duration";
  else if (outcome.nodes_outside > 0)
    outcome.failure = "nodes outside of the vessel";
  return outcome;
}

int study(const Options& options)
{
  scene::Scene scene = scene::loadScene(options.scene, options.overrides);
  tools::printWarnings("procedure_study", scene.warnings);
  if (!scene.procedure)
    throw InputError(scene.file, "procedure", "missing; give procedure: FILE");
  if (!options.through.empty())
    scene = procedure::endingWith(std::move(scene), options.through);
  const vessel::Vessel vessel = scene::buildVessel(*scene.vessel, scene.entry, scene.file,
                                                   scene::CentrelineUse::kRequired, progressOnErrorStream());
  const std::shared_ptr<const contact::WallModel> model = contact::WallModel::create(vessel.mesh);
  createFolder(options.out);
  std::ofstream table = tools::openFile(options.out + "/study.csv");
  table << "seed,success,time,nodes_outside,penetration,why\n";
  int succeeded = 0;
  for (int k = 0; k < options.runs; ++k)
  {
    const auto seed = static_cast<std::uint64_t>(options.first) + static_cast<std::uint64_t>(k);
    const Outcome outcome =
        run(procedure::perturbed(scene, options.spread, seed), vessel, model, options.out + "/" + std::to_string(seed));
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
