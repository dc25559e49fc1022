#include "session/session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "common/archive.h"
#include "common/output_file.h"
#include "session/still_image.h"
#include "simulation/hardware/robot_hardware.h"
#include "simulation/local_deformable_wall.h"

namespace endovascular_sim::session
{
namespace
{

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kNoWall = std::numeric_limits<std::uint64_t>::max();  // version of the wall in no image

std::uint64_t stepsIn(double seconds, const scene::Scene& scene)
{
  return static_cast<std::uint64_t>(std::max(0LL, std::llround(seconds / scene.solver.time_step)));
}

std::uint64_t stepsBetweenChecks(const SessionSettings& settings, const scene::Scene& scene)
{
  const double seconds = settings.outside_check > 0.0 ? settings.outside_check : 1.0 / scene.record.trajectory_rate;
  return std::max<std::uint64_t>(1, stepsIn(seconds, scene));
}

}  // namespace

/** All that changes during a run. */
struct Session::Run
{
  Run(std::shared_ptr<const World> the_world, std::shared_ptr<const scene::Scene> the_scene, std::uint64_t the_seed,
      const SessionSettings& settings)
    : world(std::move(the_world)),
      scene(std::move(the_scene)),
      seed(the_seed),
      detector(world->vessel() != nullptr && !settings.contacts
                   ? std::make_unique<contact::Detector>(world->wall(), scene::wallLaw(*scene->vessel))
                   : nullptr),
      wall(detector && !settings.wall ? simulation::makeLocalDeformableWall(*scene, *world->vessel(), *detector)
                                      : nullptr),
      simulation(*scene, world->entry(), settings.contacts ? settings.contacts.get() : detector.get(),
                 world->vessel() != nullptr ? &world->vessel()->centreline : nullptr,
                 settings.wall ? settings.wall.get() : wall.get()),
      hands(*scene),
      hardware(*scene, seed),
      observation(simulation, *world, hardware.sensors())
  {
    if (scene->flow && world->vessel() != nullptr)
      addBlood(settings);
    if (scene->motion && world->vessel() != nullptr)
      simulation.setMotion(world->motion());
    if (scene->procedure && world->vessel() != nullptr)
      scripted.emplace(*scene, world->branches(), world->entry().position);
  }

  void addBlood(const SessionSettings& settings)
  {
    std::shared_ptr<flow::FlowSource> source = settings.flow;
    if (!source)
      source = std::make_shared<flow::LocalFlowSource>(world->flow());
    intervention::DeformableWall* const deformable = settings.wall ? settings.wall.get() : wall.get();
    simulation.setBlood(
        std::make_unique<simulation::BloodCoupling>(*scene, world->bloodVessel(), world->entry(), std::move(source)),
        [deformable, rigid = &world->vessel()->mesh.vertices]() -> const std::vector<Eigen::Vector3d>&
        {
          const std::vector<Eigen::Vector3d>* detected = deformable != nullptr ? deformable->detected() : nullptr;
          return detected != nullptr ? *detected : *rigid;
        });
  }

  std::shared_ptr<const World> world;
  std::shared_ptr<const scene::Scene> scene;
  std::uint64_t seed;
  std::unique_ptr<contact::Detector> detector;
  std::unique_ptr<simulation::LocalDeformableWall> wall;  ///< null unless an instrument has a balloon
  simulation::Simulation simulation;
  std::optional<procedure::Operator> scripted;
  std::uint64_t observed_steps = 0;  ///< number of steps, with the one for which the operator has given its commands
  simulation::DrivenHands hands;
  simulation::RobotHardware hardware;
  Observation observation;
  std::optional<RunRecord> record;
  std::vector<drive::HandCommand> commands;
  std::vector<drive::HandCommand> executed;  ///< in the last step, after all faults
  double seconds = 0.0;                      ///< computing time of the last step [s]
};

/** X-ray system of a session. */
struct Session::Imaging
{
  explicit Imaging(const World& world) : image(world) {}

  StillImage image;
  std::uint64_t wall = kNoWall;  ///< version of the wall in it
};

Session::Session(std::shared_ptr<const World> world, SessionSettings settings)
  : world_(std::move(world)), settings_(std::move(settings))
{
  if (!world_)
    throw std::invalid_argument("Session: needs a world");
  if (world_->vessel() == nullptr && (settings_.contacts || settings_.wall))
    throw std::invalid_argument("Session: contacts and wall need a scene with a vessel");
  if (settings_.contacts && !settings_.wall && simulation::hasBalloon(world_->scene()))
    throw std::invalid_argument("Session: with contacts of its own, a scene with a balloon needs a wall, too");
  check_every_ = stepsBetweenChecks(settings_, world_->scene());
  last_step_ = stepsIn(world_->scene().duration, world_->scene());
  start(begin(0));
}

Session::Session(const std::string& scene, const std::vector<std::string>& overrides, SessionSettings settings,
                 const ProgressReport& progress)
  : Session(World::open(scene, overrides, progress), std::move(settings))
{
}

Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;
Session::~Session() = default;

Session::Run& Session::run() const
{
  if (!run_)
    throw std::logic_error("Session: was moved from");
  return *run_;
}

/** Scene with the varied start and procedure of a seed. */
std::shared_ptr<const scene::Scene> Session::variedScene(std::uint64_t seed) const
{
  std::shared_ptr<const scene::Scene> scene(world_, &world_->scene());
  if (seed == 0)
    return scene;
  scene = std::make_shared<const scene::Scene>(procedure::perturbed(*scene, settings_.spread, seed));
  world_->requireStart(*scene);
  return scene;
}

/** New run from the beginning of the scene, in the present wall. */
std::unique_ptr<Session::Run> Session::begin(std::uint64_t seed) const
{
  return std::make_unique<Run>(world_, variedScene(seed), seed, settings_);
}

/** Makes a run the present one. */
void Session::start(std::unique_ptr<Run> run)
{
  const std::uint64_t done = run->simulation.steps();
  if (settings_.results)
    run->record.emplace(world_, run->scene, last_step_ - std::min(last_step_, done));
  run_ = std::move(run);
  if (imaging_)
    imaging_->wall = kNoWall;
}

void Session::reset(std::uint64_t seed)
{
  run();
  std::shared_ptr<const scene::Scene> scene = variedScene(seed);  // a refused seed changes nothing
  if (settings_.wall)
    settings_.wall->reset();
  start(std::make_unique<Run>(world_, std::move(scene), seed, settings_));
}

std::uint64_t Session::seed() const
{
  return run().seed;
}

std::uint64_t Session::lastStep() const
{
  return last_step_;
}

void Session::setLastStep(std::uint64_t step)
{
  last_step_ = step;
}

bool Session::isOver() const
{
  const procedure::Operator* scripted = scriptedOperator();
  return run().simulation.steps() >= last_step_ ||
         (scripted != nullptr && scripted->progress() != procedure::Progress::kRunning);
}

/** Commands of the next step by the operator, clients and the scene's drives. */
const std::vector<drive::HandCommand>& Session::nextCommands()
{
  Run& run = this->run();
  const std::vector<drive::HandCommand>* scripted = scriptedCommands();
  if (settings_.clients)
    return run.hands.next(run.simulation, scripted, &run.hardware.faults());
  if (scripted != nullptr)
    return *scripted;
  const double end = static_cast<double>(run.simulation.steps() + 1) * run.scene->solver.time_step;
  run.commands = simulation::commandsAt(*run.scene, end);
  return run.commands;
}

/** Sets what the operator's present step asks of the patient. */
void Session::setWantedControls()
{
  Run& run = this->run();
  if (const std::optional<bool> wanted = run.scripted->wantedHyperaemia(); wanted && run.simulation.blood() != nullptr)
  {
    flow::FlowControls controls = run.simulation.blood()->controls();
    controls.hyperaemia = *wanted;
    run.simulation.blood()->setControls(controls);
  }
  if (const std::optional<bool> wanted = run.scripted->wantedBreathHold(); wanted && run.simulation.motion() != nullptr)
  {
    motion::MotionControls controls = run.simulation.motion()->controls();
    controls.breath_held = *wanted;
    run.simulation.motion()->setControls(controls);
  }
  beginWantedInjection();
}

/** Begins what the operator injects, in place of what is injected now. The syringe is filled where it holds too little.
 */
void Session::beginWantedInjection()
{
  Run& run = this->run();
  const std::optional<contrast::Injection> wanted = run.scripted->takeInjection();
  if (!wanted || run.simulation.contrast() == nullptr)
    return;
  if (run.simulation.contrast()->injector().isActive())
    run.simulation.stopInjection();
  const bool refill = run.simulation.contrast()->injector().content() < wanted->volume;
  if (run.simulation.refusalOf(*wanted, refill).empty())
    run.simulation.inject(*wanted, refill);
}

const std::vector<drive::HandCommand>* Session::scriptedCommands()
{
  Run& run = this->run();
  if (run.scripted && run.observed_steps != run.simulation.steps() + 1)
  {
    run.scripted->next(run.simulation);
    setWantedControls();
    run.observed_steps = run.simulation.steps() + 1;
  }
  return run.scripted ? &run.scripted->commands() : nullptr;
}

void Session::advance(const std::vector<drive::HandCommand>& commands)
{
  Run& run = this->run();
  const Clock::time_point before = Clock::now();
  run.executed = run.hardware.execute(run.simulation, commands);
  run.simulation.stepAll(run.executed);
  run.hardware.measure(run.simulation);
  run.seconds = std::chrono::duration<double>(Clock::now() - before).count();
  if (!run.record)
    return;
  run.record->addStep(run.simulation, run.observation.forces(), run.seconds);
  if (run.detector && run.simulation.steps() % check_every_ == 0)
    run.record->checkOutside(run.simulation, *run.detector);
}

int Session::step(int steps)
{
  if (steps < 0)
    throw std::invalid_argument("Session: the number of steps is negative");
  int made = 0;
  for (; made < steps && !isOver(); ++made)
    advance(nextCommands());
  return made;
}

void Session::requireValid(const std::vector<drive::HandCommand>& commands) const
{
  const std::vector<scene::DrivenInstrument>& instruments = scene().instruments;
  if (commands.size() != instruments.size())
    throw std::invalid_argument("Session: " + std::to_string(commands.size()) + " commands for " +
                                std::to_string(instruments.size()) + " instruments");
  for (std::size_t k = 0; k < commands.size(); ++k)
  {
    const std::string of = "Session: the command of instrument '" + instruments[k].instrument.name + "' ";
    if (!std::isfinite(commands[k].insertion) || !std::isfinite(commands[k].rotation) ||
        !std::isfinite(commands[k].pressure))
      throw std::invalid_argument(of + "is not finite");
    if (commands[k].pressure != 0.0 && !instruments[k].instrument.balloon)
      throw std::invalid_argument(of + "has a pressure, but it has no balloon");
  }
}

void Session::step(const std::vector<drive::HandCommand>& commands, int steps)
{
  requireValid(commands);
  if (steps < 0)
    throw std::invalid_argument("Session: the number of steps is negative");
  for (int k = 0; k < steps; ++k)
  {
    scriptedCommands();
    advance(commands);
  }
}

simulation::DrivenHands& Session::hands()
{
  if (!settings_.clients)
    throw std::invalid_argument("Session: SessionSettings::clients is false: the instruments follow their profiles");
  return run().hands;
}

drive::HandControl& Session::control(int instrument)
{
  const bool exists = instrument >= 0 && instrument < run().simulation.instruments();
  drive::HandControl* control = exists ? hands().control(static_cast<std::size_t>(instrument)) : nullptr;
  if (control == nullptr)
    throw std::invalid_argument("Session: clients do not drive instrument " + std::to_string(instrument) +
                                "; set its drive.source to topic");
  return *control;
}

drive::HandMotion Session::reached(int instrument) const
{
  return run().hardware.reached(run().simulation, instrument);
}

drive::Interval Session::stops(int instrument) const
{
  return run().hardware.stops(run().simulation, instrument);
}

const robot::CommandFaults& Session::faults() const
{
  return run().hardware.faults();
}

void Session::addFault(const robot::FaultSettings& fault)
{
  const std::string refusal = robot::refusalOf(fault);
  if (!refusal.empty())
    throw std::invalid_argument("Session: the fault is impossible: " + refusal);
  if (fault.instrument >= scene().instruments.size())
    throw std::invalid_argument("Session: no instrument " + std::to_string(fault.instrument) + " for a fault");
  run().hardware.faults().add(fault);
}

std::size_t Session::removeFaults(int instrument, robot::FaultAxis axis)
{
  if (instrument < 0 || instrument >= run().simulation.instruments())
    throw std::invalid_argument("Session: no instrument " + std::to_string(instrument) + " for a fault");
  return run().hardware.faults().remove(static_cast<std::size_t>(instrument), axis);
}

std::uint64_t Session::noiseSeed() const
{
  return run().hardware.seed();
}

void Session::setNoiseSeed(std::uint64_t seed)
{
  run().hardware.setSeed(seed);
}

const flow::FlowControls& Session::flowControls() const
{
  if (run().simulation.blood() == nullptr)
    throw std::logic_error("Session: blood does not flow in this scene; give the key flow");
  return run().simulation.blood()->controls();
}

void Session::setFlowControls(const flow::FlowControls& controls)
{
  flowControls();
  const std::string refusal = flow::refusalOf(controls);
  if (!refusal.empty())
    throw std::invalid_argument("Session: " + refusal);
  run().simulation.blood()->setControls(controls);
}

motion::MotionControls Session::motionControls() const
{
  if (run().simulation.motion() == nullptr)
    throw std::logic_error("Session: the patient of this scene does not move; give the key motion");
  return run().simulation.motion()->controls();
}

std::string Session::refusalOf(const motion::MotionControls& controls) const
{
  const bool has_other_rate = controls.heart_rate != motionControls().heart_rate;
  if (scene().flow && has_other_rate)
    return "heart_rate is that of the flow, which drives the heart; set it with the controls of the flow";
  return motion::refusalOf(controls);
}

void Session::setMotionControls(const motion::MotionControls& controls)
{
  const std::string refusal = refusalOf(controls);
  if (!refusal.empty())
    throw std::invalid_argument("Session: " + refusal);
  run().simulation.motion()->setControls(controls);
}

void Session::inject(const contrast::Injection& injection, bool refill)
{
  run().simulation.inject(injection, refill);
}

void Session::stopInjection()
{
  run().simulation.stopInjection();
}

void Session::refillSyringe()
{
  run().simulation.refillSyringe();
}

std::string Session::refusalOf(const contrast::Injection& injection, bool refill) const
{
  return run().simulation.refusalOf(injection, refill);
}

const std::vector<drive::HandCommand>& Session::executedCommands() const
{
  return run().executed;
}

const Observation& Session::observe() const
{
  return run().observation;
}

void Session::prepareImages()
{
  run();
  if (!imaging_)
    imaging_ = std::make_unique<Imaging>(*world_);
}

void Session::prepareInflation()
{
  if (run().wall)
    run().detector->ownModel();
}

const fluoroscopy::Frame& Session::image(const std::string& view)
{
  prepareImages();
  Run& run = this->run();
  imaging_->image.setView(view);
  imaging_->image.restart();
  const std::uint64_t version = wallVersion();
  const bool moved = std::exchange(imaging_->wall, version) != version;
  return imaging_->image.frame(run.simulation, moved ? &wall() : nullptr);
}

/** Wall that balloons deform; null without one. */
const intervention::DeformableWall* Session::deformableWall() const
{
  return settings_.wall ? settings_.wall.get() : run().wall.get();
}

std::uint64_t Session::wallVersion() const
{
  const intervention::DeformableWall* deformable = deformableWall();
  return deformable != nullptr ? deformable->version() : 0;
}

const geometry::TriangleMesh& Session::wall() const
{
  static const geometry::TriangleMesh none;
  const intervention::DeformableWall* deformable = deformableWall();
  if (deformable != nullptr && deformable->mesh() != nullptr)
    return *deformable->mesh();
  return world_->vessel() != nullptr ? world_->vessel()->mesh : none;
}

std::string Session::save(const std::function<void(Archive&)>& clients)
{
  Run& run = this->run();
  std::ostringstream stream;
  run.simulation.save(stream, world_->meshHash(),
                      [this, &run, &clients](Archive& archive)
                      {
                        if (run.scripted)
                          archive(*run.scripted);
                        const bool has_hardware = run.hardware.needsSaving();
                        if (clients)
                          clients(archive);
                        else if (settings_.clients || run.seed != 0 || has_hardware)
                          archive(run.hands);
                        if (run.seed != 0 || has_hardware)
                          archive(run.seed);
                        if (has_hardware)
                          archive(run.hardware);
                      });
  return stream.str();
}

void Session::load(const std::string& state, const std::string& origin, const LoadClients& clients)
{
  run();
  std::unique_ptr<Run> loaded;
  std::uint64_t seed = this->seed();
  do  // a second time if the state has another seed, of which its procedure depends
  {
    loaded = begin(seed);
    std::istringstream stream(state);
    loaded->simulation.load(stream, world_->meshHash(), origin,
                            [&](Archive& archive)
                            {
                              seed = 0;
                              if (loaded->scripted)
                                archive(*loaded->scripted);
                              if (clients)
                                clients(archive.atEnd() ? nullptr : &archive, loaded->simulation);
                              else if (archive.atEnd())
                                loaded->hands.restAt(loaded->simulation);
                              else
                                archive(loaded->hands);
                              if (!archive.atEnd())
                                archive(seed);
                              loaded->hardware.restartAt(loaded->simulation);
                              if (!archive.atEnd())
                                archive(loaded->hardware);
                            });
    if (seed != 0 && !settings_.varied)
      throw InputError(origin, "", "has a varied start, which this session excludes; use simulate --from-state");
  } while (seed != loaded->seed);
  start(std::move(loaded));
}

std::vector<std::string> Session::adopt(const std::string& state, const std::string& origin)
{
  std::unique_ptr<Run> adopted = begin(seed());
  std::istringstream stream(state);
  std::vector<std::string> dropped = {"contact forces and grip of the wall: solved anew in the next step"};
  if (adopted->simulation.adopt(stream, world_->meshHash(), origin))
    dropped.emplace_back("operator of the procedure, commands in progress and seed of the saved session");
  if (adopted->scripted)
    dropped.emplace_back("progress of the procedure: it begins with its first step");
  if (settings_.results)
    dropped.emplace_back("results of the steps before");
  if (!world_->scene().sensors.empty() || !world_->scene().faults.empty())
    dropped.emplace_back("samples of sensors and motion that faults have kept: they begin again");
  adopted->hands.restAt(adopted->simulation);
  adopted->hardware.restartAt(adopted->simulation);
  start(std::move(adopted));
  return dropped;
}

void Session::finish(const std::string& folder, RecordFiles files)
{
  record();
  Run& run = this->run();
  if (run.detector && !run.record->isFinished())
    run.record->checkOutside(run.simulation, *run.detector);
  if (!run.record->isFinished())
    run.record->finish(run.simulation, scriptedOperator(), wall());
  createFolder(folder);
  run.record->write(folder, files);
}

const RunRecord& Session::record() const
{
  if (!run().record)
    throw std::logic_error("Session: gathers no results; set SessionSettings::results");
  return *run().record;
}

double Session::stepSeconds() const
{
  return run().seconds;
}

const World& Session::world() const
{
  return *sharedWorld();
}

const std::shared_ptr<const World>& Session::sharedWorld() const
{
  run();
  return world_;
}

const scene::Scene& Session::scene() const
{
  return *run().scene;
}

const simulation::Simulation& Session::simulation() const
{
  return run().simulation;
}

simulation::Simulation& Session::simulation()
{
  return run().simulation;
}

const procedure::Operator* Session::scriptedOperator() const
{
  return run().scripted ? &*run().scripted : nullptr;
}

const contact::Detector* Session::detector() const
{
  return run().detector.get();
}

}  // namespace endovascular_sim::session
