#include "nodes/rod_dynamics/graph_simulation.h"

#include <sstream>
#include <utility>
#include <vector>

#include "common/archive.h"
#include "common/error.h"
#include "endovascular_sim/GetVessel.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/runtime/latched_message.h"
#include "nodes/runtime/parameters.h"
#include "nodes/runtime/ros_names.h"
#include "scene/scene_vessel.h"
#include "simulation/local_deformable_wall.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kContactTimeout = 3e-3;   ///< longest wait for one contact set in real time [s]
constexpr double kContactPatience = 10.0;  ///< the same in the other paces, which wait also for a restart [s]

/** Newest version of the wall, which may have moved since the latched message.
 *  @param latched version of this message */
std::uint64_t newestVersion(std::uint64_t latched, ros::NodeHandle& node)
{
  GetVessel vessel;
  if (!ros::service::call(node.resolveName(names::kGetVessel), vessel))
    return latched;
  return vessel.response.mesh.version + vessel.response.moved.size();
}

}  // namespace

GraphSimulation::GraphSimulation(ros::NodeHandle& node, const ros::NodeHandle& parameters, scene::Scene scene,
                                 Pace pace)
  : node_(node),
    scene_(std::move(scene)),
    clock_(node_, parameters, pace, scene_.solver.time_step),
    publisher_(node_, scene_, pace),
    drives_(node_, scene_, parameters.param<std::string>("commands", "")),
    instruments_(node_, scene_, drives_),
    renderer_(simulation::commandsAt(scene_, 0.0))
{
  if (scene_.vessel)
    contacts_ = std::make_unique<RemoteContactSource>(
        node_,
        numericParameter(parameters, "contact_patience", pace == Pace::kRealTime ? kContactTimeout : kContactPatience,
                         quantities::kWait),
        costs_);
  setState(drive::OperatingState::kDisabled, "waiting for the vessel and the contact node");
}

bool GraphSimulation::waitForVessel()
{
  ROS_INFO("waiting for the vessel");
  std::uint64_t version = 0;
  const auto takeMesh = [this, &version](const VesselMesh& mesh)
  {
    vessel_.mesh = fromMessage(mesh);
    vessel_.source = mesh.source;
    vessel_hash_ = mesh.content_hash;
    version = mesh.version;
  };
  const auto takeCentreline = [this](const VesselCentreline& centreline)
  { vessel_.centreline = fromMessage(centreline); };
  if (!waitForLatched<VesselMesh>(node_, names::kVesselMesh, takeMesh) ||
      !waitForLatched<VesselCentreline>(node_, names::kVesselCentreline, takeCentreline))
    return false;
  server_ = std::make_unique<VesselServerMonitor>(node_);
  entry_ = scene::resolveStart(scene_, vessel_);
  forces_ = std::make_unique<ContactForcePublisher>(node_, scene_, vessel_, vessel_hash_);
  if (!simulation::hasBalloon(scene_))
    return true;
  wall_ = std::make_unique<RemoteDeformableWall>(node_, newestVersion(version, node_));
  initial_wall_ = wall_->version();
  return true;
}

std::unique_ptr<simulation::Simulation> GraphSimulation::makeSimulation()
{
  return std::make_unique<simulation::Simulation>(scene_, entry_, contacts_.get(), &vessel_.centreline, wall_.get());
}

bool GraphSimulation::connect()
{
  if (!scene_.vessel)
    entry_ = scene::resolveEntry(scene_.entry, scene_.file);
  else if (!waitForVessel())
    return false;
  simulation_ = makeSimulation();
  if (scene_.procedure)
    procedure_ = std::make_unique<ProcedureDriver>(node_, scene_, vessel_.centreline, entry_.position);
  if (!contacts_)
    return true;
  ROS_INFO("waiting for the contact node");
  return contacts_->waitForNode(simulation_->initialQuery()) && (!wall_ || wall_->waitForServer());
}

void GraphSimulation::step()
{
  costs_.begin();
  const bool counted = !procedure_ || !procedure_->isOver();  // metrics end with the procedure, as those of `simulate`
  const std::vector<simulation::HandCommand>& commands = nextCommands();
  {
    const LoopCosts::Scope scope(costs_, LoopPhase::kSimulation);
    simulation_->stepAll(commands);
  }
  publishStep(commands, counted);
}

const std::vector<simulation::HandCommand>& GraphSimulation::nextCommands()
{
  const LoopCosts::Scope scope(costs_, LoopPhase::kCommands);
  return drives_.next(*simulation_, procedure_ ? &procedure_->next(*simulation_, now()) : nullptr);
}

void GraphSimulation::publishStep(const std::vector<simulation::HandCommand>& commands, bool counted)
{
  const LoopCosts::Scope scope(costs_, LoopPhase::kPublishing);
  const std::vector<RenderedHand>& hands = renderer_.render(*simulation_, commands, scene_.solver.time_step);
  const ros::Time stamp = now();
  clock_.publishStep(simulation_->steps());
  instruments_.publishStep(*simulation_, hands, stamp);
  publisher_.publishStep(*simulation_, hands, stamp);
  if (!forces_)
    return;
  const LoopCosts::Scope recording(costs_, LoopPhase::kRecording);
  forces_->publishStep(*simulation_, counted, stamp);
}

void GraphSimulation::publishHeld(double share)
{
  instruments_.publishPaused(renderer_.hands(), share, now());
  publisher_.publishGroup();
}

void GraphSimulation::publishBeginning()
{
  clock_.publish(simulation_->steps());
  if (forces_)
    forces_->publishMap(*simulation_, now());
}

void GraphSimulation::publishEnd(const std::string& reason)
{
  setState(drive::OperatingState::kDisabled, reason);
  publishHeld(0.0);
  if (forces_)
    forces_->publishMap(*simulation_, now());
}

void GraphSimulation::setState(drive::OperatingState state, const std::string& reason)
{
  instruments_.setSimulationState(state, reason, now());
}

void GraphSimulation::reset()
{
  if (wall_ && wall_->version() != initial_wall_)
    throw InputError(scene_.file, "balloon",
                     "has moved the wall, which vessel_server keeps; restart the session to begin again");
  simulation_ = makeSimulation();
  if (procedure_)
    procedure_->reset();
  drives_.reset();
  beginRun();
}

/** Forgets all that belongs to the steps before. */
void GraphSimulation::beginRun()
{
  publisher_.reset();
  instruments_.reset();
  renderer_ = HandForceRenderer(drives_.present(*simulation_));
  if (forces_)
    forces_->reset();
}

/** @throws InputError for a scene with a balloon */
void GraphSimulation::requireRigidWall() const
{
  if (wall_)
    throw InputError(scene_.file, "balloon",
                     "the wall that it moves belongs to vessel_server, so nodes neither save nor load states of this "
                     "scene; use simulate --save-state and --from-state");
}

std::string GraphSimulation::save()
{
  requireRigidWall();
  std::ostringstream stream;
  simulation_->save(stream, vessel_hash_,
                    [this](Archive& archive)
                    {
                      if (procedure_)
                        procedure_->archive(archive);
                      drives_.archive(archive);
                    });
  return stream.str();
}

void GraphSimulation::load(const std::string& state, const std::string& origin)
{
  requireRigidWall();
  std::istringstream stream(state);
  std::unique_ptr<simulation::Simulation> loaded = makeSimulation();
  Archive before;  // of the parts that keep their objects
  const auto archiveParts = [this](Archive& archive)
  {
    if (procedure_)
      procedure_->archive(archive);
    drives_.archive(archive);
  };
  archiveParts(before);
  try
  {
    loaded->load(stream, vessel_hash_, origin,
                 [this, &loaded](Archive& archive)
                 {
                   if (procedure_)
                     procedure_->archive(archive);
                   if (archive.atEnd())  // a state of `simulate`
                     drives_.restAt(*loaded);
                   else
                     drives_.archive(archive);
                 });
  }
  catch (const InputError&)
  {
    Archive kept(before.bytes());
    archiveParts(kept);
    throw;
  }
  simulation_ = std::move(loaded);
  drives_.playFrom(simulation_->time());
  beginRun();
}

}  // namespace endovascular_sim::nodes
