#include "nodes/rod_dynamics/rod_loop.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

#include <ros/topic.h>

#include "endovascular_sim/GetVessel.h"
#include "endovascular_sim/VesselCentreline.h"
#include "endovascular_sim/VesselMesh.h"
#include "nodes/conversions/vessel_conversions.h"
#include "nodes/rod_dynamics/step_scheduler.h"
#include "nodes/runtime/ros_names.h"
#include "simulation/local_deformable_wall.h"

namespace endovascular_sim::nodes
{
namespace
{

constexpr double kContactPatience = 3e-3;   // s for one contact set
constexpr double kPauseAfter = 15e-3;       // s of silence of the contact node
constexpr double kRampTime = 30e-3;         // s in which the hand's force falls to zero on any doubt, and returns
constexpr double kRecorderPatience = 10.0;  // s that a recorder is waited for
constexpr double kLate = 1e-3;              // s after its slot: then a step counts as a deadline miss
constexpr double kForceBand = 5e-3;         // N, of the bridges over missing sets
constexpr double kTorqueBand = 5e-5;        // N·m
constexpr double kNoPressure = std::numeric_limits<double>::quiet_NaN();  // none came: the scene's own counts
constexpr double kRest = 1e-3;         // s that the loop sleeps at once where it has no time left
constexpr double kIdlePeriod = 10e-3;  // s between forces of zero while paused

/** The wall may have moved since the message that is latched. */
std::uint64_t newestVersion(const VesselMesh& mesh, ros::NodeHandle& node)
{
  GetVessel vessel;
  if (!ros::service::call(node.resolveName(names::kGetVessel), vessel))
    return mesh.version;
  return vessel.response.mesh.version + vessel.response.moved.size();
}

}  // namespace

RodLoop::RodLoop(ros::NodeHandle node, scene::Scene scene, RealTimeGrant grant)
  : node_(node),
    scene_(std::move(scene)),
    grant_(std::move(grant)),
    publisher_(node_, scene_),
    rest_(grant_.granted ? shareToLeave() : 0.0, kRest)
{
  const ros::NodeHandle parameters("~");
  pause_after_ = parameters.param("pause_after", kPauseAfter);
  seconds_ = parameters.param("seconds", 0.0);
  if (scene_.vessel)
    contacts_ = std::make_unique<RemoteContactSource>(node_, parameters.param("contact_patience", kContactPatience));
  const std::size_t instruments = scene_.instruments.size();
  force_bridge_.assign(instruments, simulation::ForceFaultLimiter{kForceBand});
  torque_bridge_.assign(instruments, simulation::ForceFaultLimiter{kTorqueBand});
  hands_.resize(instruments);
  next_.resize(instruments);
  command_subscriber_.resize(instruments);
  for (std::size_t k = 0; k < instruments; ++k)
  {
    const scene::DriveScene& drive = scene_.instruments[k].drive;
    command_.push_back({drive.insertionAt(0.0), drive.rotationAt(0.0), kNoPressure});
    if (drive.source == scene::DriveSource::kDevice || drive.source == scene::DriveSource::kTopic)
      subscribe(k);
  }
}

void RodLoop::subscribe(std::size_t instrument)
{
  // Called in the thread that reads the socket, which runs ahead of all but the loop.
  ros::SubscribeOptions options = ros::SubscribeOptions::create<sensor_msgs::JointState>(
      names::kInstruments + scene_.instruments[instrument].instrument.name + names::kServoJp, 10,
      [this, instrument](const sensor_msgs::JointStateConstPtr& message) { receiveCommand(instrument, message); },
      ros::VoidPtr(), &command_queue_);
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  command_subscriber_[instrument] = node_.subscribe(options);
}

void RodLoop::receiveCommand(std::size_t instrument, const sensor_msgs::JointStateConstPtr& message)
{
  simulation::HandCommand command{0.0, 0.0, kNoPressure};
  bool insertion = false;
  bool rotation = false;
  for (std::size_t i = 0; i < std::min(message->name.size(), message->position.size()); ++i)
  {
    if (message->name[i] == names::kInsertionJoint && std::isfinite(message->position[i]))
    {
      command.insertion = message->position[i];
      insertion = true;
    }
    if (message->name[i] == names::kRotationJoint && std::isfinite(message->position[i]))
    {
      command.rotation = message->position[i];
      rotation = true;
    }
    if (message->name[i] == names::kPressureJoint && std::isfinite(message->position[i]))
      command.pressure = message->position[i];
  }
  if (!insertion || !rotation)
  {
    ROS_WARN_THROTTLE(5.0, "rod_dynamics: a servo_jp without finite positions of '%s' and '%s' was ignored",
                      names::kInsertionJoint, names::kRotationJoint);
    return;
  }
  const std::lock_guard<std::mutex> lock(command_mutex_);
  if (std::isnan(command.pressure) || !scene_.instruments[instrument].instrument.balloon)
    command.pressure = command_[instrument].pressure;
  command_[instrument] = command;
}

const std::vector<simulation::HandCommand>& RodLoop::nextCommands()
{
  const double end = static_cast<double>(simulation_->steps() + 1) * scene_.solver.time_step;
  if (procedure_)
    next_ = procedure_->next(*simulation_);
  const std::lock_guard<std::mutex> lock(command_mutex_);
  for (std::size_t k = 0; k < next_.size(); ++k)
  {
    const scene::DriveScene& drive = scene_.instruments[k].drive;
    if (command_subscriber_[k])
      next_[k] = command_[k];
    else if (!procedure_)
      next_[k] = {drive.insertionAt(end), drive.rotationAt(end), kNoPressure};
    if (std::isnan(next_[k].pressure))
      next_[k].pressure = drive.pressureAt(end);
  }
  return next_;
}

bool RodLoop::waitForVessel(scene::EntryPose& entry, vessel::Vessel& vessel)
{
  ROS_INFO("rod_dynamics: waiting for the vessel");
  const auto mesh = ros::topic::waitForMessage<VesselMesh>(names::kVesselMesh, node_);
  const auto centreline =
      mesh ? ros::topic::waitForMessage<VesselCentreline>(names::kVesselCentreline, node_) : nullptr;
  if (!centreline)
    return false;
  vessel.mesh = fromMessage(*mesh);
  vessel.centreline = fromMessage(*centreline);
  vessel.source = mesh->source;
  entry = scene::resolveStart(scene_, vessel);
  forces_ = std::make_unique<ContactForcePublisher>(node_, scene_, vessel, mesh->content_hash);
  if (simulation::hasBalloon(scene_))
    wall_ = std::make_unique<RemoteDeformableWall>(node_, newestVersion(*mesh, node_));
  return true;
}

bool RodLoop::makeSimulation()
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
  ROS_INFO("rod_dynamics: waiting for the contact node");
  return contacts_->waitForNode(simulation_->initialQuery()) && (!wall_ || wall_->waitForServer());
}

bool RodLoop::run()
{
  publisher_.publishOperatingState("DISABLED", "waiting for the vessel and the contact node");
  if (!makeSimulation())
    return false;
  std::atomic<bool> stop{false};
  std::thread diagnostics(
      [this, &stop]
      {
        leaveRealTime();
        diagnostic_updater::Updater updater;
        updater.setHardwareID("none");
        updater.add("simulation", this, &RodLoop::diagnose);
        while (!stop && ros::ok())
        {
          updater.force_update();
          ros::WallDuration(1.0).sleep();
        }
        updater.force_update();
      });
  const auto last_step =
      seconds_ > 0.0 ? static_cast<std::uint64_t>(std::llround(seconds_ / scene_.solver.time_step)) : ~std::uint64_t{0};
  publisher_.publishOperatingState("ENABLED", "");
  waitForRecorder();
  ROS_INFO("rod_dynamics: running");
  StepScheduler pace(scene_.solver.time_step);
  pace.start(Clock::now());
  while (ros::ok() && simulation_->steps() < last_step)
  {
    const Clock::time_point awake = Clock::now();
    sleepUntil(pace.next());
    if (contactIsLost())
    {
      pause();
      pace.start(Clock::now());
      continue;
    }
    const Clock::time_point begin = Clock::now();
    pace.begin(begin);
    stepOnce();
    const Clock::time_point end = Clock::now();
    countTime(begin, end, pace.slotEnd());
    const auto seconds = [](Clock::duration time) { return std::chrono::duration<double>(time).count(); };
    const double rest = rest_.after(seconds(begin - awake), seconds(end - begin));
    if (rest > 0.0)
      sleepUntil(end + StepScheduler::period(rest));
    counters_.time_losses += pace.end(Clock::now());
  }
  publisher_.publishOperatingState("DISABLED", "the session is over");
  publisher_.publishHands(hands_, 0.0);
  if (forces_)
    forces_->publishMap(*simulation_);
  stop = true;
  diagnostics.join();
  return true;
}

/** A recording must begin with the first step: waits for the subscriber of drive/applied where the launch says there is
 *  one, but not for ever. */
void RodLoop::waitForRecorder()
{
  if (!ros::NodeHandle("~").param("wait_for_recorder", false))
    return;
  const Clock::time_point end = Clock::now() + StepScheduler::period(kRecorderPatience);
  while (ros::ok() && !publisher_.isRecorded())
  {
    if (Clock::now() > end)
    {
      ROS_WARN("rod_dynamics: no recorder within %.0f s; the first steps will be missing from a recording",
               kRecorderPatience);
      return;
    }
    ros::WallDuration(0.01).sleep();
  }
}

void RodLoop::stepOnce()
{
  const std::vector<simulation::HandCommand>& commands = nextCommands();
  simulation_->stepAll(commands);
  tellHands(commands);
  publisher_.publishStep(*simulation_, hands_);
  if (forces_)
    forces_->publishStep(*simulation_);
}

/** A step that the solver refused says nothing about the force: it fades out, and in again when steps are solved. */
void RodLoop::tellHands(const std::vector<simulation::HandCommand>& used)
{
  const double dt = scene_.solver.time_step;
  const double fade = dt / kRampTime;
  force_share_ += simulation_->report().solved ? fade : -fade;
  force_share_ = std::max(0.0, std::min(1.0, force_share_));
  const bool blind = simulation_->report().first_stale_pass != contact::kNoStalePass;
  for (std::size_t k = 0; k < hands_.size(); ++k)
  {
    const simulation::HandState felt = simulation_->hand(static_cast<int>(k));
    hands_[k].command = used[k];
    hands_[k].force = force_share_ * force_bridge_[k].told(felt.force, blind, dt);
    hands_[k].torque = force_share_ * torque_bridge_[k].told(felt.torque, blind, dt);
  }
}

void RodLoop::countTime(Clock::time_point begin, Clock::time_point end, Clock::time_point slot_end)
{
  const double seconds = std::chrono::duration<double>(end - begin).count();
  const double late = std::chrono::duration<double>(end - slot_end).count();
  ++counters_.steps;
  counters_.late_steps += late > kLate;
  counters_.worst_lag = std::max(counters_.worst_lag.load(), late);
  counters_.refused_steps += !simulation_->report().solved;
  counters_.last_refused = !simulation_->report().solved || force_share_ < 1.0;
  if (!simulation_->contactSet().stale)  // an old set only estimates
    counters_.worst_penetration = std::max(counters_.worst_penetration.load(), simulation_->surfacePenetration());
  counters_.longest_step = std::max(counters_.longest_step.load(), seconds);
  counters_.total_step = counters_.total_step + seconds;
  if (!contacts_)
    return;
  counters_.stale_sets = contacts_->staleSets();
  counters_.rejected_sets = contacts_->oddSets();
}

bool RodLoop::contactIsLost() const
{
  return contacts_ && contacts_->silent() &&
         std::chrono::duration<double>(Clock::now() - contacts_->silentSince()).count() > pause_after_;
}

void RodLoop::pause()
{
  ++counters_.pauses;
  counters_.paused = true;
  publisher_.publishOperatingState("PAUSED", "the contact node, or the vessel server behind it, does not answer");
  ROS_WARN("rod_dynamics: paused at step %lu: the contact node does not answer; going on when it does",
           static_cast<unsigned long>(simulation_->steps()));
  contacts_->startListening();
  const Clock::time_point begin = Clock::now();
  while (ros::ok() && !contacts_->probe())
  {
    const double elapsed = std::chrono::duration<double>(Clock::now() - begin).count();
    const double share = std::max(0.0, 1.0 - elapsed / kRampTime);
    publisher_.publishHands(hands_, share);
    sleepUntil(Clock::now() + StepScheduler::period(share > 0.0 ? scene_.solver.time_step : kIdlePeriod));
  }
  counters_.paused = false;
  for (simulation::ForceFaultLimiter& bridge : force_bridge_)
    bridge.drop();
  for (simulation::ForceFaultLimiter& bridge : torque_bridge_)
    bridge.drop();
  if (!ros::ok())
    return;
  publisher_.publishOperatingState("ENABLED", "");
  ROS_WARN("rod_dynamics: the contact node answers again; going on after %.3f s",
           std::chrono::duration<double>(Clock::now() - begin).count());
}

void RodLoop::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status)
{
  const std::uint64_t steps = counters_.steps;
  const std::uint64_t late = counters_.late_steps;
  const double on_time = steps > 0 ? 100.0 * (1.0 - static_cast<double>(late) / static_cast<double>(steps)) : 100.0;
  if (counters_.paused)
    status.summary(diagnostic_msgs::DiagnosticStatus::ERROR, "paused: the contact node does not answer");
  else if (counters_.last_refused)
    status.summary(diagnostic_msgs::DiagnosticStatus::ERROR,
                   "the solver refuses steps: the wire is held, without force");
  else if (!grant_.granted)
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, grant_.message);
  else if (on_time < 99.0)
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "more than 1 % of the steps are late");
  else
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, "running");
  status.add("scheduling", grant_.message);
  status.add("steps", steps);
  status.add("deadline misses", late);
  status.add("on time [%]", on_time);
  status.add("step time, mean [us]", steps > 0 ? 1e6 * counters_.total_step / static_cast<double>(steps) : 0.0);
  status.add("step time, longest [us]", 1e6 * counters_.longest_step);
  status.add("old contact sets used", counters_.stale_sets.load());
  status.add("contact sets dropped (late, double or wrong)", counters_.rejected_sets.load());
  status.add("pauses", counters_.pauses.load());
  status.add("steps refused by the solver", counters_.refused_steps.load());
  status.add("behind the clock, most [s]", counters_.worst_lag.load());
  status.add("backlogs let go", counters_.time_losses.load());
  status.add("worst penetration [m]", counters_.worst_penetration.load());
}

}  // namespace endovascular_sim::nodes
