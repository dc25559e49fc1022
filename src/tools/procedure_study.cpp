#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "common/error.h"
#include "contact/detector.h"
#include "procedure/perturbation.h"
#include "results/session_run.h"
#include "scene/model/scene.h"
#include "scene/scene_file.h"
#include "scene/scene_vessel.h"
#include "simulation/local_deformable_wall.h"
#include "simulation/simulation.h"

namespace
{

using namespace endovascular_sim;  // NOLINT: a program's main file

constexpr auto kUsage =
    R"(Runs a scene's procedure from several starts that differ a little in insertion, rotation and speed, and counts how often
it comes to its end.

usage: procedure_study SCENE.yaml --out DIR [--runs N] [--first N] [--through PHASE] [--at-least N] [--set key.path=value ...]

  --out DIR             writes study.csv, and the metrics of every run in DIR/1, DIR/2, …
  --runs N              how many starts (10)
  --first N             seed of the first one (1); the others have the next ones. 0 is the scene as it is
  --through PHASE       ends every run after this phase of the procedure
  --at-least N          how many must succeed for exit code 0 (all)
  --insertion M, --rotation RAD, --speed SHARE
                        the starts' spread: ± 0.005, ± 0.5, ± 0.2
  --set key.path=value  replaces a value of the scene
  --help                prints this

exit code: 0 enough runs succeeded, 1 too few did or the scene is refused, 2 wrong use
)";

struct Options
{
  std::string scene;
  std::string out;
  std::string through;
  int runs = 10;
  int first = 1;
  int at_least = -1;
  procedure::Spread spread;
  std::vector<std::string> overrides;
};

int wrongUse(const std::string& reason)
{
  std::cerr << "procedure_study: " << reason << "\n\n" << kUsage;
  return 2;
}

/** @return −1 to go on, else the exit code */
int parse(int argc, char** argv, Options& options)
{
  for (int i = 1; i < argc; ++i)
  {
    const std::string word = argv[i];
    const bool has_value = i + 1 < argc;
    if (word == "--help" || word == "-h")
    {
      std::cout << kUsage;
      return 0;
    }
    if (word == "--out" && has_value)
      options.out = argv[++i];
    else if (word == "--through" && has_value)
      options.through = argv[++i];
    else if (word == "--runs" && has_value)
      options.runs = std::atoi(argv[++i]);
    else if (word == "--first" && has_value)
      options.first = std::atoi(argv[++i]);
    else if (word == "--at-least" && has_value)
      options.at_least = std::atoi(argv[++i]);
    else if (word == "--insertion" && has_value)
      options.spread.insertion = std::atof(argv[++i]);
    else if (word == "--rotation" && has_value)
      options.spread.rotation = std::atof(argv[++i]);
    else if (word == "--speed" && has_value)
      options.spread.speed = std::atof(argv[++i]);
    else if (word == "--set" && has_value)
      options.overrides.emplace_back(argv[++i]);
    else if (!word.empty() && word[0] != '-' && options.scene.empty())
      options.scene = word;
    else
      return wrongUse("cannot use '" + word + "'");
  }
  if (options.scene.empty() || options.out.empty())
    return wrongUse("a scene and --out are needed");
  if (options.runs < 1 || options.first < 0 || options.spread.speed >= 1.0)
    return wrongUse("--runs takes 1 or more, --first 0 or more, --speed less than 1");
  return -1;
}

/** One run. @param model wall of the vessel, shared by all runs
 *  @return what became of it; empty: success */
std::string run(const scene::Scene& scene, const vessel::Vessel& vessel,
                const std::shared_ptr<const contact::WallModel>& model, const std::string& folder, double& seconds)
{
  const scene::EntryPose entry = scene::resolveStart(scene, vessel);
  contact::Detector wall(model, scene::wallLaw(*scene.vessel));
  results::SessionRun session(scene, vessel, entry.position);
  const std::unique_ptr<simulation::LocalDeformableWall> moving_wall =
      simulation::makeLocalDeformableWall(scene, vessel, wall);
  simulation::Simulation simulation(scene, entry, &wall, &vessel.centreline, moving_wall.get());
  std::vector<simulation::WallContact> contacts;
  const auto steps = static_cast<std::uint64_t>(scene.duration / scene.solver.time_step);
  while (simulation.steps() < steps && !session.isOver())
  {
    simulation.stepAll(session.commands(simulation));
    simulation::wallContacts(simulation, contacts);
    session.addStep(simulation, contacts);
  }
  seconds = simulation.time();
  std::filesystem::create_directories(folder);
  session.finish(simulation, moving_wall ? &moving_wall->opening().mesh() : nullptr);
  session.write(folder);
  if (session.person()->progress() == procedure::Progress::kRunning)
    return "not finished within the scene's duration";
  return session.person()->failure();
}

int study(const Options& options)
{
  scene::Scene scene = scene::loadScene(options.scene, options.overrides);
  if (!scene.procedure)
    throw InputError(scene.file, "procedure", "missing; give procedure: FILE");
  if (!options.through.empty())
    scene = procedure::endingWith(std::move(scene), options.through);
  const vessel::Vessel vessel =
      scene::buildVessel(*scene.vessel, scene.entry, scene.file, scene::CentrelineUse::kRequired);
  const std::shared_ptr<const contact::WallModel> model = contact::WallModel::create(vessel.mesh);
  std::filesystem::create_directories(options.out);
  std::ofstream table(options.out + "/study.csv");
  table << "seed,success,time,why\n";
  int succeeded = 0;
  for (int k = 0; k < options.runs; ++k)
  {
    const auto seed = static_cast<std::uint64_t>(options.first + k);
    double seconds = 0.0;
    const std::string why = run(procedure::perturbed(scene, options.spread, seed), vessel, model,
                                options.out + "/" + std::to_string(seed), seconds);
    succeeded += why.empty();
    table << seed << "," << why.empty() << "," << seconds << ",\"" << why << "\"\n" << std::flush;
    std::printf("start %lu: %s after %.1f s\n", static_cast<unsigned long>(seed),
                why.empty() ? "success" : ("failed: " + why).c_str(), seconds);
    std::fflush(stdout);
  }
  if (!table)
    throw InputError(options.out + "/study.csv", "", "the disk refused it; free some space");
  std::printf("%d of %d\n", succeeded, options.runs);
  return succeeded >= (options.at_least >= 0 ? options.at_least : options.runs) ? 0 : 1;
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
    return study(options);
  }
  catch (const std::exception& error)
  {
    std::cerr << "procedure_study: " << error.what() << "\n";
    return 1;
  }
}
