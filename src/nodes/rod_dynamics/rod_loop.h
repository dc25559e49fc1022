#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include "nodes/rod_dynamics/contact_force_publisher.h"
#include "nodes/rod_dynamics/procedure_driver.h"
#include "nodes/rod_dynamics/remote_contact_source.h"
#include "nodes/rod_dynamics/remote_deformable_wall.h"
#include "nodes/rod_dynamics/rod_publisher.h"
#include "nodes/rod_dynamics/rt_throttle_guard.h"
#include "nodes/runtime/direct_callback_queue.h"
#include "nodes/runtime/real_time.h"
#include "simulation/degraded/force_fault_limiter.h"
#include "simulation/simulation.h"

namespace endovascular_sim::nodes
{

/** The rod node's loop: one simulation step per slot of the steady clock, in lock-step with the contact node.
 *
 *  A step that comes late starts at once and the slots stay where they are, so time is caught up. While the contact
 *  node is silent, old contact sets serve; after `pause_after` the simulation pauses, the hand's force ramps to zero,
 *  and it goes on, with new slots, when the node answers again. */
class RodLoop
{
public:
  RodLoop(ros::NodeHandle node, scene::Scene scene, RealTimeGrant grant);

  /** Runs until ROS ends, or for the parameter `seconds` of simulated time. @return false when it could not start */
  bool run();

private:
  using Clock = std::chrono::steady_clock;

  /** Counters for /diagnostics, written by the loop, read by another thread. */
  struct Counters
  {
    std::atomic<std::uint64_t> steps{0};
    std::atomic<std::uint64_t> late_steps{0};
    std::atomic<std::uint64_t> stale_sets{0};
    std::atomic<std::uint64_t> rejected_sets{0};
    std::atomic<std::uint64_t> pauses{0};
    std::atomic<std::uint64_t> refused_steps{0};
    std::atomic<std::uint64_t> time_losses{0};
    std::atomic<bool> last_refused{false};
    std::atomic<double> worst_penetration{0.0};  ///< [m]
    std::atomic<double> longest_step{0.0};       ///< [s]
    std::atomic<double> worst_lag{0.0};          ///< of a step behind its slot [s]
    std::atomic<double> total_step{0.0};         ///< [s]
    std::atomic<bool> paused{false};
  };

  bool makeSimulation();
  bool waitForVessel(scene::EntryPose& entry, vessel::Vessel& vessel);
  void subscribe(std::size_t instrument);
  const std::vector<simulation::HandCommand>& nextCommands();
  void receiveCommand(std::size_t instrument, const sensor_msgs::JointStateConstPtr& message);
  void tellHands(const std::vector<simulation::HandCommand>& used);
  void waitForRecorder();
  void stepOnce();
  void countTime(Clock::time_point begin, Clock::time_point end, Clock::time_point slot_end);
  bool contactIsLost() const;
  void pause();
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  ros::NodeHandle node_;
  scene::Scene scene_;
  RealTimeGrant grant_;
  double pause_after_;  ///< [s]
  double seconds_;      ///< of simulated time; 0: endless
  std::unique_ptr<RemoteContactSource> contacts_;
  std::unique_ptr<RemoteDeformableWall> wall_;  ///< null without a vessel or without a balloon
  std::unique_ptr<simulation::Simulation> simulation_;
  std::unique_ptr<ProcedureDriver> procedure_;  ///< null where the scene has none
  RodPublisher publisher_;
  RtThrottleGuard rest_;
  std::unique_ptr<ContactForcePublisher> forces_;  ///< null without a vessel
  DirectCallbackQueue command_queue_;
  std::mutex command_mutex_;
  std::vector<simulation::HandCommand> command_;     ///< newest from the drive of every instrument, guarded
  std::vector<simulation::HandCommand> next_;        ///< of the coming step
  std::vector<ros::Subscriber> command_subscriber_;  ///< per instrument; empty where its scene drives it
  double force_share_ = 1.0;                         ///< of the force that is told; fades while steps are refused
  std::vector<simulation::ForceFaultLimiter> force_bridge_, torque_bridge_;  ///< per instrument
  std::vector<RodPublisher::Hand> hands_;  ///< what they were told after the last step
  Counters counters_;
};

}  // namespace endovascular_sim::nodes
