#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>

#include "common/error.h"
#include "common/input_file.h"
#include "common/output_file.h"
#include "common/progress.h"
#include "common/quantities.h"
#include "common/text/format.h"
#include "drive/command_file.h"
#include "fluoroscopy/image/png_writer.h"
#include "results/energy_audit_csv.h"
#include "results/run_result.h"
#include "results/step_costs_csv.h"
#include "results/trajectory_csv.h"
#include "rod/energy/energy_audit.h"
#include "scene/model/scene.h"
#include "scene/scene_file.h"
#include "session/cine_files.h"
#include "session/phase_pictures.h"
#include "session/session.h"
#include "session/step_states.h"
#include "simulation/driven_hands.h"
#include "simulation/instrument_tip.h"
#include "simulation/simulation.h"
#include "tools/cine_options.h"
#include "tools/command_line.h"
#include "tools/tool_output.h"
#include "vessel/io/mesh_reader.h"

namespace
{

using namespace endovascular_sim;  // NOLINT: a program's main file
using Clock = std::chrono::steady_clock;

constexpr double kRounding = 1e-9;  // of a time [s]

struct Options
{
  std::string scene;
  std::string out;
  double seconds = NAN;  ///< simulated time; NaN: the scene's duration [s]
  std::vector<std::string> overrides;
  std::string save_state;
  double save_at = NAN;  ///< simulated time of the saved state [s]
  std::string save_steps;
  std::string from_state;
  std::string commands;
  std::vector<std::string> record;
  bool audit = false;
  bool pictures = false;
  bool x_ray = false;
  tools::CineOptions cine;
  bool no_plots = false;
  bool quiet = false;

  bool records(const std::string& table) const { return std::count(record.begin(), record.end(), table) > 0; }
};

void addOptions(tools::CommandLine& line, Options& options)
{
  line.argument("SCENE.yaml", options.scene, "scene to simulate");
  line.option(
          "--out", options.out, "DIR",
          "folder for the results, created if missing: result.json, trajectory.csv, hand_force.csv and plots; with a "
          "vessel also wall_forces.csv, metrics.json, metrics.html and instruments.csv")
      ->required();
  line.quantity("--seconds", options.seconds, "T", quantities::kDuration,
                "simulated time [s]; default: the scene's duration")
      ->check(tools::positiveNumber());
  line.overrides(options.overrides,
                 "replaces a value of the scene, e.g. --set vessel.mesh=my.stl --set drive.speed=0.05");
  line.repeated("--record", options.record, "TABLE",
                "writes a further table. nodes: nodes.csv with every node beyond the introducer at every recorded "
                "time, or every node without an introducer. costs: costs.csv with time, solves and contacts of every "
                "step")
      ->check(CLI::IsMember({"nodes", "costs"}));
  line.flag(
      "--audit", options.audit,
      "writes energy_audit.csv and energy_audit.png: work of the hands, stored and dissipated energy, dissipation by "
      "stage of the solver, and the closing error");
  line.flag("--pictures", options.pictures,
            "writes fluoroscopy/phase_01.png and so on: the C-arm's image at the end of each phase of a procedure");
  line.flag("--x-ray", options.x_ray, "writes x_ray.png: the C-arm's image of the last step");
  options.cine.addTo(line);
  CLI::Option* save = line.option("--save-state", options.save_state, "FILE", "saves the state at the time of --at");
  CLI::Option* at =
      line.quantity("--at", options.save_at, "T", quantities::kDuration, "simulated time of the saved state [s]")
          ->check(tools::positiveNumber());
  save->needs(at);
  at->needs(save);
  line.option("--save-steps", options.save_steps, "DIR",
              "saves the state at the beginning of every step of the procedure: DIR/step_01.state and so on, an "
              "exchange counted as two");
  CLI::Option* from = line.option("--from-state", options.from_state, "FILE",
                                  "starts from a state saved in the same scene; --seconds counts from it");
  line.option(
          "--commands", options.commands, "FILE",
          "CSV file with rows of time,instrument,command,values, e.g. 0.5,guidewire,move_jp,0.1,1.5: commands to the "
          "instruments with drive.source topic or device, as clients of the nodes send them")
      ->excludes(save)
      ->excludes(from);
  line.flag("--no-plots", options.no_plots, "omits the plots");
  line.flag("--quiet", options.quiet, "prints neither progress nor results, but warnings and the reason of a failure");
}

void writeNodes(std::ofstream& file, const simulation::Simulation& simulation)
{
  char line[200];
  for (int i = simulation::firstInsertedNode(simulation); i < simulation.discretisation().nodes(); ++i)
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
  int furthest = 0;
  for (int k = 1; k < simulation.instruments(); ++k)
    if (simulation.hand(k).insertion > simulation.hand(furthest).insertion)
      furthest = k;
  const simulation::HandState foremost = simulation.hand(furthest);
  row.insertion = foremost.insertion;
  row.rotation = foremost.rotation;
  row.hand_force = foremost.force;
  row.hand_torque = foremost.torque;
  row.tip = state.position.back();
  row.tip_rotation = simulation::tipRotation(simulation, furthest);
  for (int k = 0; k < simulation.instruments(); ++k)
    row.pressure = std::max(row.pressure, simulation.hand(k).pressure);
  row.nodes = static_cast<std::size_t>(simulation.discretisation().nodes() - simulation::firstInsertedNode(simulation));
  return row;
}

void writeHandForce(std::ofstream& file, const simulation::Simulation& simulation)
{
  const rod::State& state = simulation.state();
  const rod::HandForceParts& parts = state.hand_parts;
  const std::string line = formatted("%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", simulation.time(),
                                     state.inserted_length, state.hand_force, parts.bending, parts.friction,
                                     parts.inertia, parts.drag, parts.load, parts.valve, parts.configurational);
  file << line;
}

/** Tables written during the run: trajectory.csv, hand_force.csv and, on request, nodes.csv, costs.csv and
 *  energy_audit.csv. */
class Tables
{
public:
  /** @throws InputError when a file cannot be written */
  Tables(const scene::Scene& scene, const Options& options)
    : folder_(options.out),
      trajectory_(options.out + "/trajectory.csv", scene.record.trajectory_rate),
      hand_force_(tools::openFile(options.out + "/hand_force.csv"))
  {
    hand_force_ << "time,insertion,hand_force,bending,friction,inertia,drag,load,valve,configurational\n";
    if (options.records("nodes"))
    {
      nodes_.emplace(tools::openFile(options.out + "/nodes.csv"));
      *nodes_ << "time,node,x,y,z\n";
    }
    if (options.records("costs"))
      costs_.emplace(options.out + "/costs.csv");
    if (options.audit)
      audit_file_.emplace(options.out + "/energy_audit.csv");
  }

  /** Energy audit of the run; null without --audit. */
  rod::EnergyAudit* audit() { return audit_file_ ? &audit_ : nullptr; }

  /** Acceptance of the audit. */
  const results::AuditClosure& closure() const { return closure_; }

  /** @param duration computing time of the step [s] */
  void addStep(const simulation::Simulation& simulation, double duration)
  {
    if (costs_)
      costs_->add(simulation, duration);
    if (audit_file_)
      closure_.add(simulation.time(), audit_.balance());
  }

  /** Adds a row at the rate of the trajectory. */
  void addRow(const simulation::Simulation& simulation)
  {
    tools::requireWritten(trajectory_.add(rowOf(simulation)), folder_ + "/trajectory.csv");
    writeHandForce(hand_force_, simulation);
    if (nodes_)
      writeNodes(*nodes_, simulation);
    if (audit_file_)
      audit_file_->add(simulation.time(), audit_.balance());
  }

  /** @throws InputError when not everything could be written */
  void flush()
  {
    tools::requireWritten(trajectory_.flush(), folder_ + "/trajectory.csv");
    tools::requireWritten(static_cast<bool>(hand_force_.flush()), folder_ + "/hand_force.csv");
    tools::requireWritten(!nodes_ || nodes_->flush(), folder_ + "/nodes.csv");
    tools::requireWritten(!costs_ || costs_->flush(), folder_ + "/costs.csv");
    tools::requireWritten(!audit_file_ || audit_file_->flush(), folder_ + "/energy_audit.csv");
  }

private:
  std::string folder_;
  results::TrajectoryFile trajectory_;
  std::ofstream hand_force_;
  std::optional<std::ofstream> nodes_;
  std::optional<results::StepCostsFile> costs_;
  std::optional<results::EnergyAuditFile> audit_file_;
  rod::EnergyAudit audit_;
  results::AuditClosure closure_;
};

std::uint64_t stepsIn(double seconds, const scene::Scene& scene)
{
  return static_cast<std::uint64_t>(std::llround(seconds / scene.solver.time_step));
}

void writeState(const std::string& path, const std::string& state)
{
  std::ofstream stream(path, std::ios::binary);
  if (!stream.write(state.data(), static_cast<std::streamsize>(state.size())).flush())
    throw writeError(path);
}

/** Saves the state if a step of the procedure has begun. */
void saveStep(const std::string& folder, session::Session& session, session::StepStates& states)
{
  if (!states.follow(*session.scriptedOperator(), [&session] { return session.save(); }))
    return;
  createFolder(folder);
  writeState(folder + formatted("/step_%02zu.state", states.present() + 1), *states.at(states.present()));
}

void loadState(const std::string& path, session::Session& session)
{
  std::ifstream stream = openInputFile(path, "give the path of a state saved with --save-state", std::ios::binary);
  session.load({std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()}, path);
}

/** Number of the last step; the steps before a loaded state count. */
std::uint64_t lastStep(const Options& options, const session::Session& session)
{
  const scene::Scene& scene = session.scene();
  const simulation::Simulation& simulation = session.simulation();
  const std::uint64_t last = std::isfinite(options.seconds) ? simulation.steps() + stepsIn(options.seconds, scene)
                                                            : stepsIn(scene.duration, scene);
  if (last <= simulation.steps())
    throw InputError(options.from_state, "",
                     "lies at or after the scene's end; give --seconds T to continue from there");
  const std::uint64_t save_at = options.save_state.empty() ? last : stepsIn(options.save_at, scene);
  if (save_at <= simulation.steps() || save_at > last)
    throw InputError(options.save_state, "--at",
                     "lies outside the simulated time, " + std::to_string(simulation.time()) + " to " +
                         std::to_string(static_cast<double>(last) * scene.solver.time_step) + " s");
  return last;
}

/** Commands of a file to the instruments that clients drive. */
class CommandedHands
{
public:
  /** @param file path of the file; empty: no commands
   *  @param end simulated time of the end of the run [s] */
  CommandedHands(const scene::Scene& scene, const std::string& file, double end)
  {
    if (file.empty())
      return;
    player_.emplace(scene, file, drive::readCommandFile(file));
    player_->requireCommandsBefore(end);
    tools::printWarnings("simulate", player_->warnings(end));
  }

  /** Gives the commands of the coming step. */
  void play(session::Session& session)
  {
    if (player_)
      player_->play(session.observe().time(), session.hands());
  }

  void printRefusals() const
  {
    if (player_)
      tools::printWarnings("simulate", player_->refusals());
  }

private:
  std::optional<simulation::CommandPlayer> player_;
};

void showProgress(const scene::Scene& scene, std::uint64_t done, std::uint64_t all, Clock::time_point begin)
{
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  const std::string factor = formatted("%.1fx real time", static_cast<double>(done) * scene.solver.time_step / seconds);
  tools::drawProgress(static_cast<double>(done) / static_cast<double>(all), factor);
}

/** Files of the run of X-ray frames; none without --cine. */
std::optional<session::CineFiles> cineFiles(const Options& options, const session::Session& session)
{
  if (!options.cine.isGiven())
    return std::nullopt;
  const session::World& world = session.world();
  const session::CineTime time = session::cineTimeOf(options.cine.interval());
  const double begin = session.simulation().time();
  const double end = static_cast<double>(session.lastStep()) * world.scene().solver.time_step;
  if (time.begin < begin - kRounding || time.end > end + kRounding)
    throw InputError(
        options.scene, "--cine",
        formatted("%s lies outside the simulated time, %g to %g s", options.cine.interval().c_str(), begin, end));
  tools::printNotes("patient", world.patient().notes);
  return std::optional<session::CineFiles>(std::in_place, world, options.cine.settings(), time, options.out);
}

/** Steps to the end, and writes tables, state and pictures on the way.
 *  @param pictures null without --pictures */
void run(const Options& options, session::Session& session, session::PhasePictures* pictures)
{
  std::optional<session::CineFiles> cine = cineFiles(options, session);
  const scene::Scene& scene = session.scene();
  simulation::Simulation& simulation = session.simulation();
  Tables tables(scene, options);
  CommandedHands hands(scene, options.commands, static_cast<double>(session.lastStep()) * scene.solver.time_step);
  if (options.audit)
    simulation.setObserver(tables.audit());
  const std::uint64_t save_at = options.save_state.empty() ? 0 : stepsIn(options.save_at, scene);
  const auto row_every = static_cast<std::uint64_t>(
      std::max(1.0, std::round(1.0 / (scene.record.trajectory_rate * scene.solver.time_step))));
  session::StepStates step_states;
  const bool progress = !options.quiet && isatty(STDERR_FILENO);
  const Clock::time_point begin = Clock::now();
  const std::uint64_t first = simulation.steps();
  if (cine)
    cine->update(session);
  while (!session.isOver())
  {
    hands.play(session);
    session.step();
    tables.addStep(simulation, session.stepSeconds());
    if (simulation.steps() == save_at)
      writeState(options.save_state, session.save());
    if (!options.save_steps.empty() && session.scriptedOperator() != nullptr)
      saveStep(options.save_steps, session, step_states);
    if (pictures != nullptr)
      pictures->update(session);
    if (cine)
      cine->update(session);
    if (simulation.steps() % row_every != 0 && simulation.steps() != session.lastStep())
      continue;
    tables.addRow(simulation);
    if (progress)
      showProgress(scene, simulation.steps() - first, session.lastStep() - first, begin);
  }
  if (pictures != nullptr)
    pictures->update(session);
  hands.printRefusals();
  if (progress)
    std::fputc('\n', stderr);
  tables.flush();
  if (cine)
    if (const std::string missing = cine->finish(); !missing.empty())
      tools::printWarnings("simulate", {missing});
  if (!options.audit)
    return;
  simulation.setObserver(nullptr);
  if (!options.quiet || !tables.closure().accepted())
    std::fprintf(stderr, "%s\n", tables.closure().text().c_str());
}

/** Prints the steps of the scripted operator. */
void printSteps(const procedure::Operator& scripted)
{
  for (const procedure::StepRecord& step : scripted.records())
    std::fprintf(stderr, "%7.2f to %7.2f s: %s%s%s\n", step.begin, step.end, step.name.c_str(),
                 step.retries > 0 ? (" (" + std::to_string(step.retries) + " retries)").c_str() : "",
                 step.outcome == procedure::Progress::kSupportLost ? ", lost its support" : "");
}

/** True if the scripted operator has failed; prints the reason. */
bool hasFailed(const session::Session& session)
{
  const procedure::Operator* scripted = session.scriptedOperator();
  if (scripted == nullptr || scripted->progress() != procedure::Progress::kFailed)
    return false;
  std::cerr << "simulate: the procedure failed: " << scripted->failure() << "\n";
  return true;
}

/** Prints warnings and notes of a vessel on the error stream. */
void printVessel(const vessel::Vessel& vessel)
{
  tools::printWarnings("simulate", vessel.warnings);
  tools::printNotes(vessel.source, vessel.notes);
}

/** World of the scene, with its warnings and notes on the error stream. */
std::shared_ptr<const session::World> worldOf(const Options& options)
{
  scene::Scene scene = scene::loadScene(options.scene, options.overrides);
  tools::printWarnings("simulate", scene.warnings);
  createFolder(options.out);
  if (options.pictures && !scene.procedure)
    throw InputError(options.scene, "procedure", "--pictures needs a scene with a procedure");
  if (options.audit && !scene.solver.traits().observes)
    throw InputError(options.scene, "solver.scheme", "'" + scene.solver.scheme + "' has no energy audit; use kkt");
  std::shared_ptr<const session::World> world =
      session::World::make(std::move(scene), options.quiet ? ProgressReport() : progressOnErrorStream(), printVessel);
  if (world->scene().flow)
    tools::printNotes("flow", world->flow().body().remarks());
  if (world->vessel() != nullptr && options.records("nodes"))
    vessel::writeObj(world->vessel()->mesh, options.out + "/vessel.obj");
  return world;
}

void writeImage(session::Session& session, const std::string& file)
{
  tools::printNotes("patient", session.world().patient().notes);
  const fluoroscopy::Frame& frame = session.image();
  fluoroscopy::writePng(file, frame.pixels, frame.pixels, frame.image);
}

int simulate(const Options& options)
{
  const std::shared_ptr<const session::World> world = worldOf(options);
  session::SessionSettings settings;
  settings.results = true;
  settings.clients = !options.commands.empty();
  session::Session session(world, settings);
  std::optional<session::PhasePictures> pictures;
  if (options.pictures)
    pictures.emplace(*world, options.out);
  if (options.x_ray)
    session.prepareImages();
  session.prepareInflation();
  if (!options.from_state.empty())
    loadState(options.from_state, session);
  session.setLastStep(lastStep(options, session));
  run(options, session, pictures ? &*pictures : nullptr);
  if (options.x_ray)
    writeImage(session, options.out + "/x_ray.png");
  session.finish(options.out);
  if (!options.no_plots)
    tools::runPlots({"results", options.out});
  if (!options.quiet)
  {
    std::cout << session.record().resultJson();
    if (session.scriptedOperator() != nullptr)
      printSteps(*session.scriptedOperator());
  }
  const bool failed = hasFailed(session);
  const std::uint64_t rejected = session.record().result().rejectedSteps();
  if (rejected > 0)
    std::cerr << "simulate: " << rejected << " steps were rejected, in which the wire was held\n";
  return failed || rejected > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv)
{
  Options options;
  tools::CommandLine line(
      "simulate",
      "Runs a scene offline, as fast as possible, without a ROS master. The loop is that of the nodes: equal inputs "
      "give "
      "equal trajectories, bit for bit.",
      "Exit code: 0 success; 1 the scene was rejected, a step was not solved or the procedure failed (the reason is on "
      "the error stream); 2 wrong arguments.");
  addOptions(line, options);
  return line.run(argc, argv, [&options] { return simulate(options); });
}
