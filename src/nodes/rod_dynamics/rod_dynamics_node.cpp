#include "nodes/rod_dynamics/rod_dynamics_node.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <thread>
#include <utility>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/topic.h>

#include "endovascular_sim/GetVessel.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/rod_dynamics/instruments/command_diagnostics.h"
#include "nodes/rod_dynamics/instruments/unread_topics.h"
#include "nodes/runtime/node_program.h"
#include "nodes/runtime/parameters.h"
#include "nodes/runtime/ros_names.h"
#include "simulation/local_deformable_wall.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kContactTimeout = 3e-3;    ///< longest wait for one contact set [s]
constexpr double kPauseAfter = 15e-3;       ///< silence of the contact node that causes a pause [s]
constexpr double kRecorderTimeout = 10.0;   ///< longest wait for a recorder [s]
constexpr double kRest = 1e-3;              ///< duration of one sleep that avoids real-time throttling [s]
constexpr double kIdlePeriod = 10e-3;       ///< interval of zero forces while paused [s]
constexpr double kDiagnosticsPeriod = 1.0;  ///< [s]

double seconds(std::chrono::steady_clock::duration time)
{
  return std::chrono::duration<double>(time).count();
}

/** Newest version of the wall, which may have moved since the latched message. */
std::uint64_t newestVersion(const VesselMesh& mesh, ros::NodeHandle& node)
{
  GetVessel vessel;
  if (!ros::service::call(node.resolveName(names::kGetVessel), vessel))
    return mesh.version;
  return vessel.response.mesh.version + vessel.response.moved.size();
}

/** Thread with ordinary scheduling that publishes diagnostics periodically, and a last time when it ends. */
class DiagnosticsThread
{
public:
  explicit DiagnosticsThread(std::function<void(diagnostic_updater::DiagnosticStatusWrapper&)> diagnose)
    : thread_([this, diagnose = std::move(diagnose)] { loop(diagnose); })
  {
  }
  ~DiagnosticsThread()
  {
    stop_ = true;
    thread_.join();
  }
  DiagnosticsThread(const DiagnosticsThread&) = delete;
  DiagnosticsThread& operator=(const DiagnosticsThread&) = delete;

private:
  void loop(const std::function<void(diagnostic_updater::DiagnosticStatusWrapper&)>& diagnose) const
  {
    leaveRealTime();
    diagnostic_updater::Updater updater;
    updater.setHardwareID("none");
    updater.add("simulation", diagnose);
    while (!stop_ && ros::ok())
    {
      updater.force_update();
      ros::WallDuration(kDiagnosticsPeriod).sleep();
    }
    updater.force_update();
  }

  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace

RodDynamicsNode::RodDynamicsNode(const ros::NodeHandle& node, const ros::NodeHandle& parameters, scene::Scene scene,
                                 std::function<SchedulingGrant()> request)
  : node_(node),
    parameters_(parameters),
    scene_(std::move(scene)),
    request_(std::move(request)),
    pause_after_(numericParameter(parameters_, "pause_after", kPauseAfter, quantities::kWait)),
    seconds_(numericParameter(parameters_, "seconds", 0.0, quantities::kDuration)),
    publisher_(node_, scene_),
    throttle_guard_(requiredIdleShare(), kRest),
    drives_(node_, scene_),
    instruments_(node_, scene_, drives_),
    renderer_(scene_.instruments.size())
{
  if (scene_.vessel)
    contacts_ = std::make_unique<RemoteContactSource>(
        node_, numericParameter(parameters_, "contact_patience", kContactTimeout, quantities::kWait));
}

bool RodDynamicsNode::waitForVessel(scene::EntryPose& entry, vessel::Vessel& vessel)
{
  ROS_INFO("waiting for the vessel");
  const auto mesh = ros::topic::waitForMessage<VesselMesh>(names::kVesselMesh, node_);
  const auto centreline =
      mesh ? ros::topic::waitForMessage<VesselCentreline>(names::kVesselCentreline, node_) : nullptr;
  if (!centreline)
    return false;
  vessel.mesh = fromMessage(*mesh);
  vessel.centreline = fromMessage(*centreline);
  vessel.source = mesh->source;
  server_ = std::make_unique<VesselServerMonitor>(node_);
  entry = scene::resolveStart(scene_, vessel);
  forces_ = std::make_unique<ContactForcePublisher>(node_, scene_, vessel, mesh->content_hash);
  if (simulation::hasBalloon(scene_))
    wall_ = std::make_unique<RemoteDeformableWall>(node_, newestVersion(*mesh, node_));
  return true;
}

bool RodDynamicsNode::makeSimulation()
{
  scene::EntryPose entry;
  vessel::Vessel vessel;
  if (!scene_.vessel)
    entry = scene::resolveEntry(scene_.entry, scene_.file);
  else if (!waitForVessel(entry, vessel))
    return false;
  simulation_ =
      std::make_unique<simulation::Simulation>(scene_, entry, contacts_.get(), &vessel.centreline, wall_.get());
  if (scene_.procedure)
    procedure_ = std::make_unique<ProcedureDriver>(node_, scene_, vessel.centreline, entry.position);
  if (!contacts_)
    return true;
  ROS_INFO("waiting for the contact node");
  return contacts_->waitForNode(simulation_->initialQuery()) && (!wall_ || wall_->waitForServer());
}

bool RodDynamicsNode::run()
{
  instruments_.setSimulationState("DISABLED", "waiting for the vessel and the contact node");
  if (!makeSimulation())
    return false;
  grant_ = request_();  // before the thread of the diagnostics, which has ordinary scheduling
  if (!grant_.granted)
    throttle_guard_ = RtThrottleGuard(0.0, kRest);
  {
    const DiagnosticsThread diagnostics(
        [this](diagnostic_updater::DiagnosticStatusWrapper& status)
        {
          statistics_.diagnose(grant_, status);
          diagnoseCommands(drives_.reports(),
                           unreadTopics(scene_, node_.resolveName(names::kInstruments) + "/", publishedTopics(),
                                        ros::this_node::getName()),
                           status);
        });
    const auto last_step = seconds_ > 0.0 ? static_cast<std::uint64_t>(std::llround(seconds_ / scene_.solver.time_step))
                                          : ~std::uint64_t{0};
    instruments_.setSimulationState("ENABLED", "");
    waitForRecorder();
    ROS_INFO("running");
    runSteps(last_step);
    const bool is_without_vessel = server_ && server_->hasEnded();
    instruments_.setSimulationState("DISABLED",
                                    is_without_vessel ? "vessel_server has ended" : "the session has ended");
    instruments_.publishPaused(renderer_.hands(), 0.0);
    if (is_without_vessel)
      ROS_WARN("vessel_server has ended at step %lu: the simulation ends, because the deformed wall is lost",
               static_cast<unsigned long>(simulation_->steps()));
    if (forces_)
      forces_->publishMap(*simulation_);
  }
  return true;
}

/** Waits for the subscriber of drive/applied and session/sample, if the parameter `wait_for_recorder` announces one: a
 * recording must begin with the first step. */
void RodDynamicsNode::waitForRecorder() const
{
  if (!parameters_.param("wait_for_recorder", false))
    return;
  const Clock::time_point end = Clock::now() + StepScheduler::period(kRecorderTimeout);
  while (ros::ok() && (!publisher_.isRecorded() || (forces_ && !forces_->isSampled())))
  {
    if (Clock::now() > end)
    {
      ROS_WARN("no recorder within %.0f s: the recording will miss the first steps", kRecorderTimeout);
      return;
    }
    ros::WallDuration(0.01).sleep();
  }
}

void RodDynamicsNode::runSteps(std::uint64_t last_step)
{
  StepScheduler scheduler(scene_.solver.time_step);
  scheduler.start(Clock::now());
  while (!isOver() && simulation_->steps() < last_step)
  {
    countProgress();
    const Clock::time_point awake = Clock::now();
    sleepUntil(scheduler.next());
    if (isContactLost())
    {
      pause();
      scheduler.start(Clock::now());
      continue;
    }
    const Clock::time_point begin = Clock::now();
    scheduler.begin(begin);
    step();
    const Clock::time_point end = Clock::now();
    statistics_.addStep(*simulation_, {begin, end, scheduler.slotEnd()}, renderer_.isFaded());
    if (contacts_)
      statistics_.setContactSets(contacts_->staleSets(), contacts_->rejectedSets());
    const double rest = throttle_guard_.after(seconds(begin - awake), seconds(end - begin));
    if (rest > 0.0)
      sleepUntil(end + StepScheduler::period(rest));
    if (scheduler.end(Clock::now()))
      statistics_.addDiscardedBacklog();
  }
}

void RodDynamicsNode::step()
{
  const bool counted = !procedure_ || !procedure_->isOver();  // metrics end with the procedure, as those of `simulate`
  const std::vector<simulation::HandCommand>& commands =
      drives_.next(*simulation_, procedure_ ? &procedure_->next(*simulation_) : nullptr);
  simulation_->stepAll(commands);
  const std::vector<RenderedHand>& hands = renderer_.render(*simulation_, commands, scene_.solver.time_step);
  const ros::Time now = ros::Time::now();
  instruments_.publishStep(*simulation_, hands, now);
  publisher_.publishStep(*simulation_, hands, now);
  if (forces_)
    forces_->publishStep(*simulation_, counted);
}

bool RodDynamicsNode::isOver()
{
  return !ros::ok() || isStopRequested() || (server_ && server_->hasEnded());
}

bool RodDynamicsNode::isContactLost() const
{
  return contacts_ && contacts_->silent() && seconds(Clock::now() - contacts_->silentSince()) > pause_after_;
}

/** Waits for a response of the contact node, while the rendered forces ramp to zero. */
void RodDynamicsNode::pause()
{
  statistics_.addPause();
  statistics_.setPaused(true);
  instruments_.setSimulationState("PAUSED", "no response of the contact node or of the vessel server behind it");
  ROS_WARN("paused at step %lu: no response of the contact node; continues with its next response",
           static_cast<unsigned long>(simulation_->steps()));
  contacts_->startListening();
  const Clock::time_point begin = Clock::now();
  while (!isOver() && !contacts_->probe())
  {
    const double share = std::max(0.0, 1.0 - seconds(Clock::now() - begin) / HandForceRenderer::kRampTime);
    instruments_.publishPaused(renderer_.hands(), share);
    countProgress();
    sleepUntil(Clock::now() + StepScheduler::period(share > 0.0 ? scene_.solver.time_step : kIdlePeriod));
  }
  statistics_.setPaused(false);
  renderer_.reset();
  if (isOver())
    return;
  instruments_.setSimulationState("ENABLED", "");
  ROS_WARN("the contact node responds; continuing after %.3f s", seconds(Clock::now() - begin));
}

}  // namespace endovascular_sim::nodes
