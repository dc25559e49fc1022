#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>

#include "common/error.h"
#include "contact/detector.h"
#include "procedure/phase_pictures.h"
#include "results/run_result.h"
#include "results/session_run.h"
#include "results/step_costs_csv.h"
#include "results/trajectory_csv.h"
#include "results/wall_force_map.h"
#include "results/wall_force_report.h"
#include "scene/model/scene.h"
#include "scene/scene_file.h"
#include "scene/scene_vessel.h"
#include "simulation/local_deformable_wall.h"
#include "simulation/simulation.h"

namespace
{

using namespace endovascular_sim;  // NOLINT: a program's main file
using Clock = std::chrono::steady_clock;

constexpr auto kUsage =
    R"(Runs a scene offline, as fast as it can, without a ROS master. The loop is the nodes' own, so the same inputs give the
same trajectory bit for bit.

usage: simulate SCENE.yaml --out DIR [--seconds T] [--set key.path=value ...] [--record nodes|costs]
                [--pictures] [--save-state FILE --at T] [--from-state FILE] [--no-plots] [--quiet]

  --out DIR             writes result.json, trajectory.csv, hand_force.csv, wall_forces.csv, plots and, with a vessel, metrics.json,
                        metrics.html and instruments.csv there; made when it is missing
  --seconds T           runs for T seconds of simulated time instead of the scene's duration
  --set key.path=value  replaces a value of the scene, e.g. --set vessel.mesh=my.stl --set drive.speed=0.05
  --record nodes        also writes nodes.csv: every node at every recorded step
  --record costs        also writes costs.csv: what every step cost, in time, solves and contacts
  --pictures            also writes fluoroscopy/phase_01.png and so on: what the C-arm sees at the end of every phase of a procedure
  --save-state FILE     writes the state at the time of --at T, in seconds of simulated time, and goes on
  --from-state FILE     begins with a state that was saved in this scene; T of --seconds is then counted from it
  --no-plots            leaves the plots out
  --quiet               no progress bar
  --help                prints this

exit code: 0 done, 1 the scene is refused, a step could not be solved or the scene's procedure failed (the reason goes to the
error stream), 2 wrong use
)";

struct Options
{
  std::string scene;
  std::string out;
  double seconds = NAN;
  std::vector<std::string> overrides;
  std::string save_state;
  double save_at = NAN;  ///< [s]
  std::string from_state;
  bool record_nodes = false;
  bool record_costs = false;
  bool pictures = false;
  bool plots = true;
  bool quiet = false;
};

int wrongUse(const std::string& reason)
{
  std::cerr << "simulate: " << reason << "\n\n" << kUsage;
  return 2;
}

/** @return false where it is not a positive number */
bool parseSeconds(const std::string& text, double& seconds)
{
  char* end = nullptr;
  seconds = std::strtod(text.c_str(), &end);
  return *end == '\0' && std::isfinite(seconds) && seconds > 0.0;
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
    if (word == "--no-plots")
      options.plots = false;
    else if (word == "--pictures")
      options.pictures = true;
    else if (word == "--quiet")
      options.quiet = true;
    else if (word == "--out" && has_value)
      options.out = argv[++i];
    else if (word == "--set" && has_value)
      options.overrides.emplace_back(argv[++i]);
    else if (word == "--seconds" && has_value)
    {
      if (!parseSeconds(argv[++i], options.seconds))
        return wrongUse(std::string("--seconds takes a positive number of seconds, not '") + argv[i] + "'");
    }
    else if (word == "--save-state" && has_value)
      options.save_state = argv[++i];
    else if (word == "--from-state" && has_value)
      options.from_state = argv[++i];
    else if (word == "--at" && has_value)
    {
      if (!parseSeconds(argv[++i], options.save_at))
        return wrongUse(std::string("--at takes a positive number of seconds, not '") + argv[i] + "'");
    }
    else if (word == "--record" && has_value)
    {
      const std::string what = argv[++i];
      if (what != "nodes" && what != "costs")
        return wrongUse("--record takes 'nodes' or 'costs', not '" + what + "'");
      (what == "nodes" ? options.record_nodes : options.record_costs) = true;
    }
    else if (!word.empty() && word[0] != '-' && options.scene.empty())
      options.scene = word;
    else
      return wrongUse("cannot use '" + word + "'");
  }
  if (options.scene.empty() || options.out.empty())
    return wrongUse("a scene and --out are needed");
  if (options.save_state.empty() != std::isnan(options.save_at))
    return wrongUse("--save-state FILE and --at T belong together");
  return -1;
}

[[noreturn]] void diskRefused(const std::string& path)
{
  throw InputError(path, "", "the disk refused it; free some space");
}

void writeFile(const std::string& path, const std::string& text)
{
  std::ofstream stream(path);
  if (!(stream << text) || !stream.flush())
    diskRefused(path);
}

std::ofstream openFile(const std::string& path)
{
  std::ofstream stream(path);
  if (!stream)
    throw InputError(path, "", "cannot be written; check the folder's permissions and the disk's free space");
  return stream;
}

void drawProgress(double done, double factor)
{
  constexpr int kWidth = 40;
  const int filled = static_cast<int>(done * kWidth);
  std::fprintf(stderr, "\r[%s%s] %3.0f %%  %.1fx real time ", std::string(filled, '#').c_str(),
               std::string(kWidth - filled, '.').c_str(), 100.0 * done, factor);
}

void writeNodes(std::ofstream& file, const simulation::Simulation& simulation)
{
  char line[200];
  for (int i = results::firstInsertedNode(simulation); i < simulation.discretisation().nodes(); ++i)
  {
    const Eigen::Vector3d& x = simulation.state().position[i];
    std::snprintf(line, sizeof line, "%.17g,%d,%.17g,%.17g,%.17g\n", simulation.time(), i, x.x(), x.y(), x.z());
    file << line;
  }
}

results::TrajectoryRow rowOf(const simulation::Simulation& simulation)
{
  const rod::State& state = simulation.state();
  results::TrajectoryRow row;
  row.time = simulation.time();
  row.insertion = state.inserted_length;
  row.rotation = state.rotation;
  row.hand_force = state.hand_force;
  row.hand_torque = state.hand_torque;
  row.tip = state.position.back();
  for (int k = 0; k < simulation.instruments(); ++k)
    row.pressure = std::max(row.pressure, simulation.hand(k).pressure);
  row.nodes = static_cast<std::size_t>(simulation.discretisation().nodes() - results::firstInsertedNode(simulation));
  return row;
}

void writeHandForce(std::ofstream& file, const simulation::Simulation& simulation)
{
  const rod::State& state = simulation.state();
  const rod::HandForceParts& parts = state.hand_parts;
  char line[240];
  std::snprintf(line, sizeof line, "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", simulation.time(),
                state.inserted_length, state.hand_force, parts.bending, parts.friction, parts.inertia, parts.drag,
                parts.load, parts.valve);
  file << line;
}

/** The vessel of a scene with everything that is made from it. */
struct Surroundings
{
  std::unique_ptr<contact::Detector> wall;
  std::unique_ptr<simulation::LocalDeformableWall> moving_wall;  ///< null without a balloon
  std::unique_ptr<results::WallForceMap> wall_forces;
  std::unique_ptr<results::SessionRun> session;        ///< null without a vessel
  std::unique_ptr<procedure::PhasePictures> pictures;  ///< null where none are wanted
  scene::EntryPose entry;
  vessel::CentrelineTree centreline;
  std::vector<Eigen::Vector3d> wall_points;
  std::uint64_t mesh_hash = 0;
};

Surroundings build(const scene::Scene& scene)
{
  Surroundings made;
  if (!scene.vessel)
  {
    made.entry = scene::resolveEntry(scene.entry, scene.file);
    return made;
  }
  const vessel::Vessel vessel = scene::buildVessel(*scene.vessel, scene.entry, scene.file, scene::centrelineUse(scene));
  for (const std::string& note : vessel.notes)
    std::cerr << vessel.source << ": " << note << "\n";
  made.entry = scene::resolveStart(scene, vessel);
  made.centreline = vessel.centreline;
  made.wall_points = vessel.mesh.vertices;
  made.wall_forces = std::make_unique<results::WallForceMap>(scene.record.wall_force_threshold, vessel);
  made.mesh_hash = vessel.mesh.hash();
  made.wall = std::make_unique<contact::Detector>(vessel.mesh, scene::wallLaw(*scene.vessel));
  made.moving_wall = simulation::makeLocalDeformableWall(scene, vessel, *made.wall);
  made.session = std::make_unique<results::SessionRun>(scene, vessel, made.entry.position);
  return made;
}

std::uint64_t stepsIn(double seconds, const scene::Scene& scene)
{
  return static_cast<std::uint64_t>(std::llround(seconds / scene.solver.time_step));
}

/** The scripted operator's part of a saved state. */
std::function<void(Archive&)> sessionOf(const Surroundings& surroundings)
{
  results::SessionRun* session = surroundings.session.get();
  return [session](Archive& archive)
  {
    if (session != nullptr)
      session->archive(archive);
  };
}

void saveState(const std::string& path, simulation::Simulation& simulation, const Surroundings& surroundings)
{
  std::ofstream stream(path, std::ios::binary);
  if (stream)
    simulation.save(stream, surroundings.mesh_hash, sessionOf(surroundings));
  if (!stream.flush())
    throw InputError(path, "", "cannot be written; choose a folder that exists and has room");
}

void loadState(const std::string& path, simulation::Simulation& simulation, const Surroundings& surroundings)
{
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
    throw InputError(path, "", "cannot be read; give the path of a state saved with --save-state");
  simulation.load(stream, surroundings.mesh_hash, path, sessionOf(surroundings));
}

/** Steps until the end, those before a loaded state included. */
std::uint64_t lastStep(const scene::Scene& scene, const Options& options, const simulation::Simulation& simulation)
{
  const std::uint64_t last = std::isfinite(options.seconds) ? simulation.steps() + stepsIn(options.seconds, scene)
                                                            : stepsIn(scene.duration, scene);
  if (last <= simulation.steps())
    throw InputError(options.from_state, "", "is of the scene's end or later; give --seconds T to go on from there");
  const std::uint64_t save_at = options.save_state.empty() ? last : stepsIn(options.save_at, scene);
  if (save_at <= simulation.steps() || save_at > last)
    throw InputError(options.save_state, "--at",
                     "is not within the time that is simulated, " + std::to_string(simulation.time()) + " to " +
                         std::to_string(static_cast<double>(last) * scene.solver.time_step) + " s");
  return last;
}

void takePicture(const Surroundings& surroundings, const simulation::Simulation& simulation)
{
  if (surroundings.pictures)
    surroundings.pictures->update(
        simulation, *surroundings.session->scriptedOperator(),
        surroundings.moving_wall ? surroundings.moving_wall->opening().mesh() : surroundings.session->vessel().mesh);
}

void run(const scene::Scene& scene, const Options& options, simulation::Simulation& simulation,
         const Surroundings& surroundings, results::RunResult& result, std::uint64_t steps)
{
  results::TrajectoryFile trajectory(options.out + "/trajectory.csv", scene.record.trajectory_rate);
  std::ofstream hand_force = openFile(options.out + "/hand_force.csv");
  hand_force << "time,insertion,hand_force,bending,friction,inertia,drag,load,valve\n";
  std::ofstream nodes;
  if (options.record_nodes)
  {
    nodes = openFile(options.out + "/nodes.csv");
    nodes << "time,node,x,y,z\n";
  }
  std::optional<results::StepCostsFile> costs;
  if (options.record_costs)
    costs.emplace(options.out + "/costs.csv");
  const std::uint64_t save_at = options.save_state.empty() ? 0 : stepsIn(options.save_at, scene);
  const auto row_every = static_cast<std::uint64_t>(
      std::max(1.0, std::round(1.0 / (scene.record.trajectory_rate * scene.solver.time_step))));
  std::vector<simulation::WallContact> contacts;
  const bool progress = !options.quiet && isatty(STDERR_FILENO);
  const Clock::time_point begin = Clock::now();
  const std::uint64_t first = simulation.steps() + 1;
  for (std::uint64_t k = first; k <= steps; ++k)
  {
    if (surroundings.session && surroundings.session->isFinished())
      break;
    const std::vector<simulation::HandCommand> commands =
        surroundings.session ? surroundings.session->commands(simulation)
                             : simulation::commandsAt(scene, static_cast<double>(k) * scene.solver.time_step);
    const Clock::time_point before = Clock::now();
    simulation.stepAll(commands);
    const double took = std::chrono::duration<double>(Clock::now() - before).count();
    result.addStep(simulation, took);
    if (costs)
      costs->add(simulation, took);
    if (k == save_at)
      saveState(options.save_state, simulation, surroundings);
    if (surroundings.wall_forces)
    {
      simulation::wallContacts(simulation, contacts);
      surroundings.wall_forces->add(contacts, simulation.time(), scene.solver.time_step);
      surroundings.session->addStep(simulation, contacts);
    }
    takePicture(surroundings, simulation);
    if (k % row_every != 0 && k != steps)
      continue;
    if (!trajectory.add(rowOf(simulation)))
      diskRefused(options.out + "/trajectory.csv");
    writeHandForce(hand_force, simulation);
    if (surroundings.wall)
      result.checkOutside(simulation, *surroundings.wall);
    if (options.record_nodes)
      writeNodes(nodes, simulation);
    if (progress)
      drawProgress(static_cast<double>(k + 1 - first) / static_cast<double>(steps + 1 - first),
                   static_cast<double>(k + 1 - first) * scene.solver.time_step /
                       std::chrono::duration<double>(Clock::now() - begin).count());
  }
  takePicture(surroundings, simulation);
  if (progress)
    std::fputc('\n', stderr);
  if (!trajectory.flush())
    diskRefused(options.out + "/trajectory.csv");
  if (!hand_force.flush())
    diskRefused(options.out + "/hand_force.csv");
  if (options.record_nodes && !nodes.flush())
    diskRefused(options.out + "/nodes.csv");
  if (costs && !costs->flush())
    diskRefused(options.out + "/costs.csv");
}

void writeWallForces(const std::string& folder, const Surroundings& surroundings)
{
  const results::WallForceMap& map = *surroundings.wall_forces;
  std::vector<results::WallForceRow> rows;
  for (const results::WallForce& force : map.touched())
    rows.push_back({force, map.centre(force.triangle), map.regionName(force.region)});
  writeFile(folder + "/wall_forces.csv", results::wallForcesCsv(std::move(rows)));
  writeFile(folder + "/vessel_points.csv", results::vesselPointsCsv(surroundings.wall_points));
}

void finishSession(const simulation::Simulation& simulation, const Surroundings& surroundings)
{
  surroundings.session->metrics().setWallForces(surroundings.wall_forces->summary());
  const simulation::LocalDeformableWall* wall = surroundings.moving_wall.get();
  surroundings.session->finish(simulation, wall != nullptr ? &wall->opening().mesh() : nullptr);
}

/** How the scripted operator got on. */
void tellProcedure(const Surroundings& surroundings)
{
  if (!surroundings.session || !surroundings.session->scriptedOperator())
    return;
  const procedure::Operator& scripted = *surroundings.session->scriptedOperator();
  for (const procedure::StepRecord& step : scripted.records())
    std::fprintf(stderr, "%7.2f to %7.2f s: %s%s%s\n", step.begin, step.end, step.name.c_str(),
                 step.retries > 0 ? (" (" + std::to_string(step.retries) + " retries)").c_str() : "",
                 step.outcome == procedure::Progress::kSupportLost ? ", lost its support" : "");
  if (!scripted.failure().empty())
    std::cerr << "simulate: the procedure failed: " << scripted.failure() << "\n";
}

void plot(const Options& options)
{
  const std::filesystem::path script =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "plot_results.py";
  const std::string command = "/usr/bin/python3 '" + script.string() + "' '" + options.out + "' >/dev/null";
  if (std::system(command.c_str()) != 0)
    std::cerr << "simulate: the plots could not be drawn (" << command << ")\n";
}

int simulate(const Options& options)
{
  const scene::Scene scene = scene::loadScene(options.scene, options.overrides);
  std::filesystem::create_directories(options.out);
  Surroundings surroundings = build(scene);
  if (options.pictures)
  {
    if (!surroundings.session || !surroundings.session->scriptedOperator())
      throw InputError(options.scene, "procedure", "--pictures needs a scene with a procedure");
    surroundings.pictures = std::make_unique<procedure::PhasePictures>(scene, options.out);
  }
  simulation::Simulation simulation(scene, surroundings.entry, surroundings.wall.get(), &surroundings.centreline,
                                    surroundings.moving_wall.get());
  if (!options.from_state.empty())
    loadState(options.from_state, simulation, surroundings);
  const std::uint64_t steps = lastStep(scene, options, simulation);
  results::RunResult result(scene, surroundings.mesh_hash, steps - simulation.steps());
  run(scene, options, simulation, surroundings, result, steps);
  if (surroundings.session)
    finishSession(simulation, surroundings);
  if (simulation::hasBalloon(scene))
    result.setTreatment(
        scene, simulation,
        surroundings.session ? surroundings.session->metrics().lesions() : std::vector<results::LesionOutcome>());
  const std::string text = result.json(simulation, surroundings.wall_forces.get());
  writeFile(options.out + "/result.json", text);
  writeFile(options.out + "/scene.yaml", scene.resolved_yaml);
  if (surroundings.wall_forces)
  {
    writeWallForces(options.out, surroundings);
    surroundings.session->write(options.out);
  }
  if (options.plots)
    plot(options);
  if (!options.quiet)
    std::cout << text;
  if (!options.quiet)
    tellProcedure(surroundings);
  if (result.rejectedSteps() > 0)
  {
    std::cerr << "simulate: " << result.rejectedSteps() << " steps could not be solved; the wire was held in them\n";
    return 1;
  }
  return surroundings.session && surroundings.session->scriptedOperator() &&
                 surroundings.session->scriptedOperator()->progress() == procedure::Progress::kFailed
             ? 1
             : 0;
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
    return simulate(options);
  }
  catch (const std::exception& error)
  {
    std::cerr << "simulate: " << error.what() << "\n";
    return 1;
  }
}
