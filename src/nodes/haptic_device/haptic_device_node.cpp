#include "nodes/haptic_device/haptic_device_node.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <mutex>
#include <utility>

#include "nodes/conversions/joint_state_conversions.h"
#include "nodes/conversions/operating_state_conversions.h"
#include "nodes/haptic_device/haptic_parameters.h"
#include "nodes/runtime/diagnostics_publication.h"
#include "nodes/runtime/guarded_subscription.h"
#include "nodes/runtime/node_program.h"
#include "nodes/runtime/ros_names.h"

namespace endovascular_sim::nodes
{
namespace
{

using haptics::DeviceState;

constexpr double kLongestWait = 0.1;      ///< longest wait of the port's thread, which then checks for the end [s]
constexpr double kShutdownTime = 50e-3;   ///< longest time for sending the last bytes [s]
constexpr unsigned long kTimerSlack = 1;  ///< timer slack of the kernel in the port's thread [ns]

double steadyNow()
{
  timespec time = {};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/** Wall clock time for the device; never simulated time. */
haptics::WallTime wallNow()
{
  const ros::WallTime now = ros::WallTime::now();
  return {now.sec, now.nsec};
}

void addPassivity(const std::string& name, const haptics::PassivityReport& report,
                  diagnostic_updater::DiagnosticStatusWrapper& status)
{
  status.add(name + ": energy [J]", report.energy);
  status.add(name + ": injected damping", report.injected_damping);
  status.add(name + ": dissipated energy [J]", report.dissipated);
  status.add(name + ": activations", report.activations);
}

}  // namespace

HapticDeviceNode::HapticDeviceNode(const ros::NodeHandle& node, const ros::NodeHandle& parameters,
                                   const scene::Scene& scene)
  : link_(linkOptions(parameters, scene)), wake_up_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC))
{
  const scene::DriveSource source = deviceInstrument(scene).drive.source;
  if (source != scene::DriveSource::kDevice && source != scene::DriveSource::kTopic)
    ROS_WARN("%s: haptic_device is true, but no drive uses the device; set drive.source: device", scene.file.c_str());
  const std::string instrument = names::kInstruments + deviceInstrument(scene).instrument.name;
  const std::string channel = names::kHaptic + parameters.param<std::string>("channel", "hand");
  ros::NodeHandle handle(node);
  servo_publisher_ = handle.advertise<sensor_msgs::JointState>(instrument + names::kServoJp, 100);
  measured_publisher_ = handle.advertise<sensor_msgs::JointState>(channel + names::kMeasuredJs, 100, true);
  state_publisher_ = handle.advertise<crtk_msgs::OperatingState>(channel + names::kOperatingState, 10, true);
  reason_publisher_ = handle.advertise<crtk_msgs::StringStamped>(channel + names::kStateReason, 10, true);

  force_subscriber_ = subscribeGuarded<sensor_msgs::JointState>(
      node, instrument + names::kSetpointJs, 1, [this](const sensor_msgs::JointState& state) { receiveForce(state); },
      &force_queue_);
  reason_subscriber_ = subscribeGuarded<crtk_msgs::StringStamped>(
      node, instrument + names::kStateReason, 10,
      [this](const crtk_msgs::StringStamped& reason)
      {
        simulation_reason_ = reason.string;
        updateSimulationState();
      },
      &force_queue_);
  simulation_subscriber_ = subscribeGuarded<crtk_msgs::OperatingState>(
      node, instrument + names::kOperatingState, 10,
      [this](const crtk_msgs::OperatingState& state)
      {
        simulation_state_ = drive::operatingState(state.state).value_or(DeviceState::kFault);
        updateSimulationState();
      },
      &force_queue_);

  diagnostics_.setHardwareID(link_.portName());
  diagnostics_.add("haptic device", this, &HapticDeviceNode::diagnose);
  diagnostics_timer_ = handle.createWallTimer(ros::WallDuration(1.0),
                                              [this](const ros::WallTimerEvent&) { publishDiagnostics(diagnostics_); });
  force_spinner_.start();
  thread_ = std::thread(&HapticDeviceNode::servePort, this);
}

HapticDeviceNode::~HapticDeviceNode()
{
  force_spinner_.stop();
  running_ = false;
  wake();
  thread_.join();
  close(wake_up_);
}

void HapticDeviceNode::servePort()
{
  prctl(PR_SET_TIMERSLACK, kTimerSlack);
  publishState(DeviceState::kDisabled, "starting", {});

  while (running_ && !isStopRequested())
  {
    std::unique_lock<PriorityInheritanceMutex> lock(mutex_);
    link_.service(steadyNow(), wallNow());
    const auto samples = link_.host().takeMotion();
    const auto log = link_.host().takeLog();
    const haptics::HandForce force = link_.host().renderedForce();
    const haptics::HandMotion command = link_.host().motion().command();
    const DeviceState state = link_.host().state();
    const std::string reason = link_.host().reason();
    const double until = link_.wakeAt();
    const int descriptor = link_.descriptor();
    const bool wants_write = link_.waitsForWrite();
    lock.unlock();

    publishMotion(samples, force);
    publishState(state, reason, command);
    for (const haptics::LogLine& line : log)
      ROS_LOG(static_cast<ros::console::Level>(std::min<int>(line.level, ros::console::levels::Fatal)),
              ROSCONSOLE_DEFAULT_NAME, "haptic device: %s", line.text.c_str());
    waitForPort(until, descriptor, wants_write);
  }
  shutDownDevice();
}

void HapticDeviceNode::waitForPort(double until, int descriptor, bool wants_write) const
{
  const double wait = std::clamp(until - steadyNow(), 0.0, kLongestWait);
  timespec timeout = {};
  timeout.tv_nsec = static_cast<long>(wait * 1e9);
  pollfd sources[] = {{wake_up_, POLLIN, 0},
                      {descriptor, static_cast<short>(wants_write ? POLLIN | POLLOUT : POLLIN), 0}};
  ppoll(sources, 2, &timeout, nullptr);
  std::uint64_t count = 0;
  while (read(wake_up_, &count, sizeof count) > 0)
  {
  }
}

void HapticDeviceNode::wake() const
{
  const std::uint64_t one = 1;
  if (write(wake_up_, &one, sizeof one) != sizeof one)
    ROS_WARN_ONCE("the thread of the serial line could not be woken; it wakes by itself within 0.1 s");
}

void HapticDeviceNode::receiveForce(const sensor_msgs::JointState& state)
{
  const std::optional<std::size_t> insertion = jointOf(state, names::kInsertionJoint);
  const std::optional<std::size_t> rotation = jointOf(state, names::kRotationJoint);
  if (!insertion || !rotation || std::max(*insertion, *rotation) >= state.effort.size())
  {
    ++forces_without_effort_;
    return;
  }
  haptics::HandMotion cause{std::nan(""), std::nan("")};
  if (std::max(*insertion, *rotation) < state.position.size())
    cause = {state.position[*insertion], state.position[*rotation]};
  const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
  if (isStopRequested())
    return;  // the device has been shut down, or will be at once
  const DeviceState before = link_.host().state();
  link_.commandForce({state.effort[*insertion], state.effort[*rotation]}, cause, steadyNow(), wallNow());
  if (!link_.isIdle() || link_.host().state() != before)
    wake();
}

/** Pauses the device while the simulation does not run. Reason and state may arrive in any order. */
void HapticDeviceNode::updateSimulationState()
{
  if (!simulation_state_)
    return;
  const bool is_running = simulation_state_ == DeviceState::kEnabled;
  const std::string reason = simulation_reason_.empty()
                                 ? std::string("the simulation is ") + drive::nameOf(*simulation_state_)
                                 : "simulation: " + simulation_reason_;
  const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
  if (isStopRequested())
    return;
  link_.setSimulationState(is_running ? "" : reason, steadyNow(), wallNow());
  wake();
}

void HapticDeviceNode::publishMotion(const std::vector<haptics::MotionSample>& samples, const haptics::HandForce& force)
{
  countProgress();
  sensor_msgs::JointState message;
  message.header.stamp = ros::Time::now();
  message.header.frame_id = names::kIntroducerFrame;
  message.name = {names::kInsertionJoint, names::kRotationJoint};
  for (const haptics::MotionSample& sample : samples)
  {
    message.position = {sample.command.insertion, sample.command.rotation};
    message.effort.clear();
    servo_publisher_.publish(message);
    message.effort = {force.force, force.torque};
    measured_publisher_.publish(message);
  }
}

void HapticDeviceNode::publishState(DeviceState state, const std::string& reason, const haptics::HandMotion& command)
{
  if (has_published_ && state == published_state_ && reason == published_reason_)
    return;
  has_published_ = true;
  published_state_ = state;
  published_reason_ = reason;
  announceState(state, reason);
  if (state == DeviceState::kDisabled)
    publishInvalidMeasurement(command);
}

/** Publishes and logs a state; the reason precedes it. */
void HapticDeviceNode::announceState(DeviceState state, const std::string& reason)
{
  const ros::Time now = ros::Time::now();
  reason_publisher_.publish(reasonMessage(reason, now));
  // The device counts from its start: it is homed. The hand moves, not the device: it is not busy.
  drive::ControlState announced;
  announced.state = state;
  state_publisher_.publish(toMessage(announced, now));
  if (state == DeviceState::kEnabled)
    ROS_INFO("haptic device ENABLED");
  else
    ROS_WARN("haptic device %s: %s", drive::nameOf(state), reason.c_str());
}

/** Publishes a latched measurement with stamp 0: late subscribers learn that no measurement is valid. */
void HapticDeviceNode::publishInvalidMeasurement(const haptics::HandMotion& command)
{
  sensor_msgs::JointState invalid;
  invalid.name = {names::kInsertionJoint, names::kRotationJoint};
  invalid.position = {command.insertion, command.rotation};
  invalid.effort = {0.0, 0.0};
  measured_publisher_.publish(invalid);
}

void HapticDeviceNode::shutDownDevice()
{
  const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
  const double begin = steadyNow();
  link_.shutDown(begin, wallNow());
  while (!link_.isIdle() && steadyNow() < begin + kShutdownTime)
  {
    usleep(500);
    link_.flush(steadyNow());
  }
}

void HapticDeviceNode::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status)
{
  using diagnostic_msgs::DiagnosticStatus;
  const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
  const haptics::RosserialHost& host = link_.host();
  const haptics::ParserCounters& parser = host.parserCounters();
  const haptics::HostCounters& counters = host.counters();
  const DeviceState state = host.state();
  const auto level = state == DeviceState::kEnabled ? DiagnosticStatus::OK
                     : state == DeviceState::kFault ? DiagnosticStatus::ERROR
                                                    : DiagnosticStatus::WARN;
  status.summary(level, drive::nameOf(state) + (host.reason().empty() ? "" : ": " + host.reason()));
  status.add("scheduling", grant_.describe());
  status.add("last error", link_.lastError());
  status.add("reconnects", link_.opened() > 0 ? link_.opened() - 1 : 0);
  status.add("lost links", counters.links_lost);
  status.add("bytes", parser.bytes);
  status.add("frames", parser.frames);
  status.add("length errors", parser.bad_lengths);
  status.add("oversized frames", parser.over_long);
  status.add("checksum errors", parser.bad_sums);
  status.add("resyncs", parser.resyncs);
  status.add("skipped bytes", parser.skipped_bytes);
  status.add("unknown ids", counters.unknown_ids);
  status.add("unused frames", counters.unused_frames);
  status.add("malformed payloads", counters.malformed);
  status.add("samples", counters.samples);
  status.add("rejected samples", host.motion().rejected());
  status.add("motion rebases", host.motion().rebased());
  status.add("topic requests", counters.topic_requests);
  status.add("time requests", counters.times_answered);
  status.add("forces received", counters.forces_received);
  status.add("forces not finite", counters.forces_not_finite);
  status.add("forces without effort", forces_without_effort_.load());
  status.add("forces superseded", host.output().superseded());
  status.add("frames sent", host.output().sent());
  status.add("frames dropped", host.output().dropped());
  status.add("force [N]", host.renderedForce().force);
  status.add("torque [N m]", host.renderedForce().torque);
  addPassivity("insertion", host.shaper().insertion(), status);
  addPassivity("rotation", host.shaper().rotation(), status);
  IgnoredMessages::ofProcess().diagnose(status);
  status.add("refused topics", host.topics().refused().size());
  for (const auto& [id, refused] : host.topics().refused())
    status.add("refused " + refused.topic.name, refused.reason);
}

}  // namespace endovascular_sim::nodes
