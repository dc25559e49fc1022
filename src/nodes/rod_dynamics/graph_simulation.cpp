#include "nodes/rod_dynamics/graph_simulation.h"

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
    hardware_(node_, scene_),
    instruments_(node_, scene_, drives_),
    renderer_(simulation::commandsAt(scene_, 0.0))
{
  if (scene_.vessel)
    contacts_ = std::make_shared<RemoteContactSource>(
        node_,
        numericParameter(parameters, "contact_patience", pace == Pace::kRealTime ? kContactTimeout : kContactPatience,
                         quantities::kWait),
        costs_);
  if (scene_.flow)
    flow_ = std::make_shared<RemoteFlowSource>(node_, costs_);
  setState(drive::OperatingState::kDisabled, "waiting for the vessel and the contact node");
}

/** Vessel of vessel_server; none when ROS shut down before. */
std::optional<vessel::Vessel> GraphSimulation::waitForVessel()
{
  ROS_INFO("waiting for the vessel");
  vessel::Vessel vessel;
  std::uint64_t version = 0;
  const auto takeMesh = [&vessel, &version](const VesselMesh& mesh)
  {
    vessel.mesh = fromMessage(mesh);
    vessel.source = mesh.source;
    version = mesh.version;
  };
  const auto takeCentreline = [&vessel](const VesselCentreline& centreline)
  {
    vessel.centreline = fromMessage(centreline);
    vessel.lesions = lesionsFromMessage(centreline);
  };
  if (!waitForLatched<VesselMesh>(node_, names::kVesselMesh, takeMesh) ||
      !waitForLatched<VesselCentreline>(node_, names::kVesselCentreline, takeCentreline))
    return std::nullopt;
  server_ = std::make_unique<VesselServerMonitor>(node_);
  if (simulation::hasBalloon(scene_))
    wall_ = std::make_shared<RemoteDeformableWall>(node_, newestVersion(version, node_), scene_.flow.has_value());
  return vessel;
}

bool GraphSimulation::connect()
{
  std::optional<vessel::Vessel> vessel;
  if (scene_.vessel && !(vessel = waitForVessel()))
    return false;
  const std::shared_ptr<const session::World> world = session::World::make(scene_, std::move(vessel));
  session::SessionSettings settings;
  settings.contacts = contacts_;
  settings.wall = wall_;
  settings.flow = flow_;
  settings.varied = false;
  session_.emplace(world, std::move(settings));
  connectFlow();
  if (scene_.motion)
    motion_.emplace(node_, *session_, MotionPart{scene_.flow.has_value()});
  if (scene_.procedure)
    procedure_.emplace(node_, scene_);
  if (!contacts_)
    return true;
  forces_ = std::make_unique<ContactForcePublisher>(node_, scene_, *world->vessel(), world->meshHash());
  ROS_INFO("waiting for the contact node");
  if (!contacts_->waitForNode(simulation().initialQuery()) || (wall_ && !wall_->waitForServer()))
    return false;
  if (!flow_)
    return true;
  ROS_INFO("waiting for the node hemodynamics");
  return flow_->waitForNode();
}

void GraphSimulation::connectFlow()
{
  if (!flow_)
    return;
  const flow::VesselFlowTree& network = simulation().blood()->places().tree();
  flow_->setSizes({static_cast<std::size_t>(network.tree.nodes), network.tree.cells.size(),
                   simulation::pressureLines(scene_).size(), session_->world().vessel()->lesions.size(),
                   scene_.contrast ? session_->world().contrastVessel().cells.size() : 0});
  hemodynamics_.emplace(node_, *session_);
  if (scene_.contrast)
    contrast_.emplace(node_, *session_);
}

bool GraphSimulation::needsFlow() const
{
  const simulation::BloodCoupling* blood = simulation().blood();
  return flow_ && blood != nullptr && blood->isPending() && blood->isDue(simulation().steps());
}

bool GraphSimulation::needsWall()
{
  return flow_ && wall_ && wall_->isBehind(simulation().steps());
}

const vessel::CentrelineTree& GraphSimulation::centreline() const
{
  static const vessel::CentrelineTree none;
  const vessel::Vessel* vessel = session_->world().vessel();
  return vessel != nullptr ? vessel->centreline : none;
}

void GraphSimulation::step()
{
  costs_.begin();
  const procedure::Operator* scripted = session_->scriptedOperator();
  // Metrics end with the procedure, as those of `simulate`.
  const bool counted = scripted == nullptr || scripted->progress() == procedure::Progress::kRunning;
  const std::vector<drive::HandCommand>& commands = nextCommands();
  if (flow_)
    flow_->setStamp(now());
  {
    const LoopCosts::Scope scope(costs_, LoopPhase::kSimulation);
    session_->step(commands);
  }
  publishStep(session_->executedCommands(), counted);
}

std::string GraphSimulation::inject(const InjectContrast::Request& request)
{
  const std::string text = GraphContrast::inject(*session_, request);
  contrast_->publishInputs(*session_, now());
  return text;
}

const std::vector<drive::HandCommand>& GraphSimulation::nextCommands()
{
  const LoopCosts::Scope scope(costs_, LoopPhase::kCommands);
  const std::vector<drive::HandCommand>* scripted = session_->scriptedCommands();
  if (procedure_)
    procedure_->publishChanges(*session_->scriptedOperator(), simulation().steps(), now());
  hardware_.applyChanges(*session_);
  if (hemodynamics_)
    hemodynamics_->applyChanges(*session_, now());
  if (motion_)
    motion_->applyChanges(*session_, now());
  return drives_.next(simulation(), scripted, session_->faults());
}

void GraphSimulation::publishStep(const std::vector<drive::HandCommand>& commands, bool counted)
{
  const LoopCosts::Scope scope(costs_, LoopPhase::kPublishing);
  const std::vector<RenderedHand>& hands = renderer_.render(simulation(), commands, scene_.solver.time_step);
  const ros::Time stamp = now();
  clock_.publishStep(simulation().steps());
  instruments_.publishStep(simulation(), hands, stamp);
  publisher_.publishStep(simulation(), hands, stamp);
  hardware_.publishStep(*session_, stamp);
  if (contrast_)
    contrast_->publishInputs(*session_, stamp);
  if (!forces_)
    return;
  const LoopCosts::Scope recording(costs_, LoopPhase::kRecording);
  forces_->publishStep(simulation(), counted, stamp);
}

void GraphSimulation::publishHeld(double share)
{
  instruments_.publishPaused(renderer_.hands(), share, now());
  publisher_.publishGroup();
}

void GraphSimulation::publishBeginning()
{
  clock_.publish(simulation().steps());
  if (forces_)
    forces_->publishMap(simulation(), now());
}

void GraphSimulation::publishControls(std::uint32_t run)
{
  if (hemodynamics_)
    hemodynamics_->beginRun(*session_, run, now());
  if (motion_)
    motion_->beginRun(*session_, run, now());
  if (contrast_)
    contrast_->beginRun(*session_, run);
}

void GraphSimulation::publishEnd(const std::string& reason)
{
  setState(drive::OperatingState::kDisabled, reason);
  publishHeld(0.0);
  if (forces_)
    forces_->publishMap(simulation(), now());
}

void GraphSimulation::setState(drive::OperatingState state, const std::string& reason)
{
  instruments_.setSimulationState(state, reason, now());
}

void GraphSimulation::reset()
{
  session_->reset();
  drives_.reset();
  beginRun();
}

/** Forgets all that belongs to the steps before. */
void GraphSimulation::beginRun()
{
  publisher_.reset();
  instruments_.reset();
  renderer_ = HandForceRenderer(drives_.present(simulation()));
  if (procedure_)
    procedure_->reset();
  if (forces_)
    forces_->reset();
}

std::string GraphSimulation::save()
{
  return session_->save([this](Archive& archive) { drives_.archive(archive); });
}

void GraphSimulation::load(const std::string& state, const std::string& origin)
{
  Archive before;
  drives_.archive(before);
  const std::string wall = wall_ ? wall_->save() : "";
  const auto loadDrives = [this](Archive* archive, const simulation::Simulation& loaded)
  {
    if (archive == nullptr)  // a state of `simulate`
      drives_.restAt(loaded);
    else
      drives_.archive(*archive);
  };
  try
  {
    session_->load(state, origin, loadDrives);
  }
  catch (const InputError&)
  {
    Archive kept(before.bytes());
    drives_.archive(kept);
    if (wall_)
      wall_->load(wall);
    throw;
  }
  drives_.playFrom(simulation().time());
  beginRun();
}

}  // namespace endovascular_sim::nodes
