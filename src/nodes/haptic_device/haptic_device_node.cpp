#include <poll.h>
#include <sys/eventfd.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <ctime>
#include <exception>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <ros/topic.h>
#include <sensor_msgs/JointState.h>

#include "common/error.h"
#include "endovascular_sim/OperatingState.h"
#include "haptics/host/haptic_link.h"
#include "nodes/haptic_device/haptic_topics.h"
#include "nodes/runtime/priority_mutex.h"
#include "nodes/runtime/real_time.h"
#include "nodes/runtime/ros_names.h"
#include "nodes/runtime/scene_parameters.h"

namespace endovascular_sim::nodes
{
namespace
{

using haptics::DeviceState;

constexpr double kLongestWait = 0.1;      ///< of the port's thread, to notice the end of the node [s]
constexpr double kGoodbyeTime = 50e-3;    ///< for the last bytes to leave [s]
constexpr double kBusyTime = 0.5;         ///< after the last motion [s]
constexpr double kFrameBits = 210.0;      ///< of a sample or a force on the line
constexpr double kDeviceDelay = 2e-3;     ///< of the device and this computer, rather too long than too short [s]
constexpr unsigned long kTimerSlack = 1;  ///< of the kernel in the port's thread [ns]

double steadyNow()
{
  timespec time = {};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/** The device is told the wall's time, never a simulated one. */
haptics::WallTime wallNow()
{
  const ros::WallTime now = ros::WallTime::now();
  return {now.sec, now.nsec};
}

const char* stateName(DeviceState state)
{
  switch (state)
  {
    case DeviceState::kEnabled:
      return "ENABLED";
    case DeviceState::kPaused:
      return "PAUSED";
    case DeviceState::kFault:
      return "FAULT";
    case DeviceState::kDisabled:
      break;
  }
  return "DISABLED";
}

/** The instrument that the device drives; the first one where none says so. */
const scene::DrivenInstrument& driven(const scene::Scene& scene)
{
  const auto device =
      std::find_if(scene.instruments.begin(), scene.instruments.end(),
                   [](const scene::DrivenInstrument& one) { return one.drive.source == scene::DriveSource::kDevice; });
  return device != scene.instruments.end() ? *device : scene.instruments.front();
}

/** Where the hand is: after a restart of this node in a running simulation that is where the wire was left, which the
 *  first measured_js tells; before the simulation runs it is the scene's beginning. */
haptics::HandMotion handPosition(const scene::Scene& scene)
{
  constexpr double kPatience = 1.0;  // s; a running simulation speaks a thousand times in it
  const auto hand = ros::topic::waitForMessage<sensor_msgs::JointState>(
      names::kInstruments + driven(scene).instrument.name + names::kMeasuredJs, ros::Duration(kPatience));
  if (hand && hand->position.size() == 2 && std::isfinite(hand->position[0]) && std::isfinite(hand->position[1]))
    return {hand->position[0], hand->position[1]};
  return {driven(scene).drive.initial_insertion, driven(scene).drive.initial_rotation};
}

haptics::LinkOptions linkOptions(const ros::NodeHandle& parameters, const scene::Scene& scene)
{
  haptics::LinkOptions options;
  options.port = parameters.param<std::string>("port", "/dev/ttyACM0");
  options.baud = parameters.param("baud", options.baud);
  haptics::SerialPort::checkBaud(options.baud, parameters.resolveName("baud"));
  options.host.types = hapticTopicTypes();
  options.host.start = handPosition(scene);
  haptics::ForceLimits& limits = options.host.limits;
  const auto positive = [&parameters](const char* name, double otherwise)
  {
    const double value = parameters.param(name, otherwise);
    if (!std::isfinite(value) || value <= 0.0)
      throw InputError("parameter server", parameters.resolveName(name), "must be a positive number");
    return value;
  };
  limits.force = positive("force_limit", std::min(limits.force, driven(scene).drive.force_limit));
  limits.torque = positive("torque_limit", std::min(limits.torque, driven(scene).drive.torque_limit));
  limits.force_rate = positive("force_rate", limits.force_rate);
  limits.torque_rate = positive("torque_rate", limits.torque_rate);
  haptics::ShaperSettings& shaping = options.host.shaping;
  shaping.passivity = parameters.param("passivity", shaping.passivity);
  shaping.cutoff = parameters.param("force_cutoff", shaping.cutoff);
  if (!std::isfinite(shaping.cutoff) || shaping.cutoff < 0.0)
    throw InputError("parameter server", parameters.resolveName("force_cutoff"), "must not be negative");
  const double line = 2.0 * kFrameBits / static_cast<double>(options.baud);
  shaping.insertion.delay = shaping.rotation.delay = positive("loop_delay", line + kDeviceDelay);
  shaping.insertion.resolution = positive("insertion_resolution", shaping.insertion.resolution);
  shaping.rotation.resolution = positive("rotation_resolution", shaping.rotation.resolution);
  shaping.insertion.damping_limit = positive("damping_limit", shaping.insertion.damping_limit);
  shaping.rotation.damping_limit = positive("turning_damping_limit", shaping.rotation.damping_limit);
  shaping.insertion.force_limit = std::min(shaping.insertion.force_limit, limits.force);
  shaping.rotation.force_limit = std::min(shaping.rotation.force_limit, limits.torque);
  return options;
}

/** The haptic device in the graph: its motion drives the instrument, the instrument's force goes to its motors.
 *
 *  One thread waits on the serial line, another on the force; both write the line under one lock, so a force leaves
 *  at once and frames do not interleave. */
class HapticDevice
{
public:
  HapticDevice(const ros::NodeHandle& node, const ros::NodeHandle& parameters, const scene::Scene& scene,
               bool real_time);
  ~HapticDevice();
  HapticDevice(const HapticDevice&) = delete;
  HapticDevice& operator=(const HapticDevice&) = delete;

private:
  void servePort();
  void waitForPort(double until, int descriptor, bool for_write) const;
  void takeForce(const sensor_msgs::JointState& state);
  void publishMotion(const std::vector<haptics::MotionSample>& samples, const haptics::HandForce& force);
  void publishState(DeviceState state, const std::string& reason, const haptics::HandMotion& command);
  void sayGoodbye();
  void wake() const;
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  PriorityInheritanceMutex mutex_;  ///< guards link_
  haptics::HapticLink link_;
  int wake_up_ = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  std::atomic<bool> running_{true};
  std::atomic<std::uint64_t> bad_forces_{0};
  bool real_time_;

  // The port's thread only.
  DeviceState published_state_ = DeviceState::kDisabled;
  OperatingState operating_state_;
  double moved_at_ = -std::numeric_limits<double>::infinity();
  haptics::HandMotion last_command_;

  ros::CallbackQueue force_queue_;
  ros::Publisher servo_;
  ros::Publisher measured_;
  ros::Publisher state_;
  ros::Subscriber force_;
  diagnostic_updater::Updater diagnostics_;
  ros::WallTimer diagnostics_timer_;
  ros::AsyncSpinner force_spinner_{1, &force_queue_};
  std::thread thread_;
};

HapticDevice::HapticDevice(const ros::NodeHandle& node, const ros::NodeHandle& parameters, const scene::Scene& scene,
                           bool real_time)
  : link_(linkOptions(parameters, scene)), real_time_(real_time)
{
  const std::string instrument = names::kInstruments + driven(scene).instrument.name;
  const std::string channel = names::kHaptic + parameters.param<std::string>("channel", "hand");
  ros::NodeHandle handle(node);
  servo_ = handle.advertise<sensor_msgs::JointState>(instrument + names::kServoJp, 100);
  measured_ = handle.advertise<sensor_msgs::JointState>(channel + names::kMeasuredJs, 100, true);
  state_ = handle.advertise<OperatingState>(channel + names::kOperatingState, 10, true);

  ros::NodeHandle force_handle(node);
  force_handle.setCallbackQueue(&force_queue_);
  force_ = force_handle.subscribe(instrument + names::kMeasuredJs, 1, &HapticDevice::takeForce, this,
                                  ros::TransportHints().tcpNoDelay());

  diagnostics_.setHardwareID(link_.portName());
  diagnostics_.add("haptic device", this, &HapticDevice::diagnose);
  diagnostics_timer_ = handle.createWallTimer(ros::WallDuration(1.0),
                                              [this](const ros::WallTimerEvent&) { diagnostics_.force_update(); });
  force_spinner_.start();
  thread_ = std::thread(&HapticDevice::servePort, this);
}

HapticDevice::~HapticDevice()
{
  force_spinner_.stop();
  running_ = false;
  wake();
  thread_.join();
  close(wake_up_);
}

void HapticDevice::servePort()
{
  prctl(PR_SET_TIMERSLACK, kTimerSlack);
  publishState(DeviceState::kDisabled, "starting", {});

  while (running_)
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
    const bool for_write = link_.waitsForWrite();
    lock.unlock();

    publishMotion(samples, force);
    publishState(state, reason, command);
    for (const haptics::LogLine& line : log)
      ROS_LOG(static_cast<ros::console::Level>(std::min<int>(line.level, ros::console::levels::Fatal)),
              ROSCONSOLE_DEFAULT_NAME, "the haptic device says: %s", line.text.c_str());
    waitForPort(until, descriptor, for_write);
  }
  sayGoodbye();
}

void HapticDevice::waitForPort(double until, int descriptor, bool for_write) const
{
  const double wait = std::clamp(until - steadyNow(), 0.0, kLongestWait);
  timespec timeout = {};
  timeout.tv_nsec = static_cast<long>(wait * 1e9);
  pollfd sources[] = {{wake_up_, POLLIN, 0},
                      {descriptor, static_cast<short>(for_write ? POLLIN | POLLOUT : POLLIN), 0}};
  ppoll(sources, 2, &timeout, nullptr);
  std::uint64_t count = 0;
  while (read(wake_up_, &count, sizeof count) > 0)
  {
  }
}

void HapticDevice::wake() const
{
  const std::uint64_t one = 1;
  if (write(wake_up_, &one, sizeof one) != sizeof one)
    ROS_WARN_ONCE("the haptic device's thread could not be woken; it wakes by itself within 0.1 s");
}

void HapticDevice::takeForce(const sensor_msgs::JointState& state)
{
  if (state.effort.size() < 2)
  {
    ++bad_forces_;
    return;
  }
  haptics::HandMotion caused_by{std::nan(""), std::nan("")};
  if (state.position.size() >= 2)
    caused_by = {state.position[0], state.position[1]};
  const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
  const DeviceState before = link_.host().state();
  link_.commandForce({state.effort[0], state.effort[1]}, caused_by, steadyNow(), wallNow());
  if (!link_.isIdle() || link_.host().state() != before)
    wake();
}

void HapticDevice::publishMotion(const std::vector<haptics::MotionSample>& samples, const haptics::HandForce& force)
{
  sensor_msgs::JointState message;
  message.header.stamp = ros::Time::now();
  message.header.frame_id = names::kIntroducerFrame;
  message.name = {names::kInsertionJoint, names::kRotationJoint};
  for (const haptics::MotionSample& sample : samples)
  {
    message.position = {sample.command.insertion, sample.command.rotation};
    message.effort.clear();
    servo_.publish(message);
    message.effort = {force.force, force.torque};
    measured_.publish(message);
  }
}

void HapticDevice::publishState(DeviceState state, const std::string& reason, const haptics::HandMotion& command)
{
  const double now = steadyNow();
  if (command.insertion != last_command_.insertion || command.rotation != last_command_.rotation)
    moved_at_ = now;
  last_command_ = command;
  const bool busy = state != DeviceState::kDisabled && now - moved_at_ < kBusyTime;
  if (state == published_state_ && reason == operating_state_.reason && busy == operating_state_.is_busy)
    return;
  const bool announce = state != published_state_ || reason != operating_state_.reason;
  published_state_ = state;
  operating_state_.header.stamp = ros::Time::now();
  operating_state_.state = stateName(state);
  operating_state_.reason = reason;
  operating_state_.is_busy = busy;
  state_.publish(operating_state_);
  if (!announce)
    return;
  if (state == DeviceState::kEnabled)
    ROS_INFO("haptic device enabled");
  else
    ROS_WARN("haptic device %s: %s", operating_state_.state.c_str(), reason.c_str());
  if (state != DeviceState::kDisabled)
    return;
  // Latched: a late listener learns that there is no valid measurement (stamp 0).
  sensor_msgs::JointState invalid;
  invalid.name = {names::kInsertionJoint, names::kRotationJoint};
  invalid.position = {command.insertion, command.rotation};
  invalid.effort = {0.0, 0.0};
  measured_.publish(invalid);
}

void HapticDevice::sayGoodbye()
{
  const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
  const double begin = steadyNow();
  link_.shutDown(begin, wallNow());
  while (!link_.isIdle() && steadyNow() < begin + kGoodbyeTime)
  {
    usleep(500);
    link_.flush(steadyNow());
  }
}

void HapticDevice::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status)
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
  status.summary(level, stateName(state) + (host.reason().empty() ? "" : ": " + host.reason()));
  status.add("real-time scheduling", real_time_ ? "granted" : "refused: allow rtprio in /etc/security/limits.d");
  status.add("last error", link_.lastError());
  status.add("reconnects", link_.opened() > 0 ? link_.opened() - 1 : 0);
  status.add("links lost", counters.links_lost);
  status.add("bytes", parser.bytes);
  status.add("frames", parser.frames);
  status.add("bad lengths", parser.bad_lengths);
  status.add("over-long frames", parser.over_long);
  status.add("bad sums", parser.bad_sums);
  status.add("resyncs", parser.resyncs);
  status.add("skipped bytes", parser.skipped_bytes);
  status.add("unknown ids", counters.unknown_ids);
  status.add("unused frames", counters.unused_frames);
  status.add("malformed payloads", counters.malformed);
  status.add("samples", counters.samples);
  status.add("samples not believed", host.motion().rejected());
  status.add("motion rebased", host.motion().rebased());
  status.add("topic requests", counters.topic_requests);
  status.add("times answered", counters.times_answered);
  status.add("forces received", counters.forces_received);
  status.add("forces not finite", counters.forces_not_finite);
  status.add("forces without effort", bad_forces_.load());
  status.add("forces superseded", host.output().superseded());
  status.add("frames sent", host.output().sent());
  status.add("frames dropped", host.output().dropped());
  status.add("force [N]", host.renderedForce().force);
  status.add("torque [N m]", host.renderedForce().torque);
  const auto passivity = [&status](const std::string& name, const haptics::PassivityReport& report)
  {
    status.add(name + ": energy [J]", report.energy);
    status.add(name + ": damping injected now", report.injected_damping);
    status.add(name + ": dissipated [J]", report.dissipated);
    status.add(name + ": times active", report.activations);
  };
  passivity("insertion", host.shaper().insertion());
  passivity("rotation", host.shaper().rotation());
  status.add("refused topics", host.topics().refused().size());
  for (const auto& [id, refused] : host.topics().refused())
    status.add("refused " + refused.topic.name, refused.reason);
}

}  // namespace
}  // namespace endovascular_sim::nodes

int main(int argc, char** argv)
{
  endovascular_sim::nodes::keepOffLockStepCpu();
  ros::init(argc, argv, "haptic_device");
  // For the threads that it starts, ROS's own, too: ahead of ordinary ones, behind the simulation's.
  constexpr int kLowest = 1;
  const bool real_time = endovascular_sim::nodes::makeThreadRealTime(kLowest);
  const ros::NodeHandle node;
  try
  {
    const auto scene = endovascular_sim::nodes::sceneFromParameters(node);
    const endovascular_sim::nodes::HapticDevice device(node, ros::NodeHandle("~"), scene, real_time);
    endovascular_sim::nodes::spinUntilShutdown();
  }
  catch (const std::exception& error)
  {
    ROS_FATAL("%s", error.what());
    return 1;
  }
  return 0;
}
