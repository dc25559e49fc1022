#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <crtk_msgs/OperatingState.h>
#include <crtk_msgs/StringStamped.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include "haptics/host/haptic_link.h"
#include "nodes/runtime/priority_inheritance_mutex.h"
#include "nodes/runtime/real_time.h"
#include "scene/model/scene.h"

namespace endovascular_sim::nodes
{

/** ROS node of the haptic device: its motion drives an instrument, and the instrument's force is rendered by its
 * motors.
 *
 *  One thread waits for the serial line, another for forces. Both write to the line under one lock: a force is sent at
 *  once, and frames do not interleave. */
class HapticDeviceNode
{
public:
  /** Opens the line and starts the threads.
   *  @param parameters handle of the private parameters
   *  @throws InputError when a parameter is invalid */
  HapticDeviceNode(const ros::NodeHandle& node, const ros::NodeHandle& parameters, const scene::Scene& scene);
  ~HapticDeviceNode();
  HapticDeviceNode(const HapticDeviceNode&) = delete;
  HapticDeviceNode& operator=(const HapticDeviceNode&) = delete;

  /** Sets the scheduling that the diagnostics report. */
  void setScheduling(SchedulingGrant grant)
  {
    const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
    grant_ = std::move(grant);
  }

private:
  void servePort();
  void waitForPort(double until, int descriptor, bool wants_write) const;
  void receiveForce(const sensor_msgs::JointState& state);
  void updateSimulationState();
  void publishMotion(const std::vector<haptics::MotionSample>& samples, const haptics::HandForce& force);
  void publishState(haptics::DeviceState state, const std::string& reason, const haptics::HandMotion& command);
  void announceState(haptics::DeviceState state, const std::string& reason);
  void publishInvalidMeasurement(const haptics::HandMotion& command);
  void shutDownDevice();
  void wake() const;
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  SchedulingGrant grant_;
  PriorityInheritanceMutex mutex_;  ///< guards link_
  haptics::HapticLink link_;
  int wake_up_;  ///< event that ends a wait of the port's thread
  std::atomic<bool> running_{true};
  std::atomic<std::uint64_t> forces_without_effort_{0};

  // Used by the port's thread only.
  haptics::DeviceState published_state_ = haptics::DeviceState::kDisabled;
  std::string published_reason_;
  bool has_published_ = false;

  // Used by the forces' thread only.
  std::optional<drive::OperatingState> simulation_state_;  ///< newest operating_state of the instrument
  std::string simulation_reason_;                          ///< newest state_reason of the instrument

  ros::CallbackQueue force_queue_;
  ros::Publisher servo_publisher_, measured_publisher_, state_publisher_, reason_publisher_;
  diagnostic_updater::Updater diagnostics_;
  // Last, so that they end before the members that their callbacks use.
  ros::Subscriber force_subscriber_, simulation_subscriber_, reason_subscriber_;
  ros::WallTimer diagnostics_timer_;
  ros::AsyncSpinner force_spinner_{1, &force_queue_};
  std::thread thread_;
};

}  // namespace endovascular_sim::nodes
