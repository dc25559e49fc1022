#pragma once

#include <chrono>
#include <functional>
#include <memory>

#include <ros/ros.h>

#include "nodes/rod_dynamics/contact_force_publisher.h"
#include "nodes/rod_dynamics/instruments/drive_commands.h"
#include "nodes/rod_dynamics/instruments/hand_force_renderer.h"
#include "nodes/rod_dynamics/instruments/instrument_publisher.h"
#include "nodes/rod_dynamics/procedure_driver.h"
#include "nodes/rod_dynamics/remote_contact_source.h"
#include "nodes/rod_dynamics/remote_deformable_wall.h"
#include "nodes/rod_dynamics/rod_publisher.h"
#include "nodes/rod_dynamics/rt_throttle_guard.h"
#include "nodes/rod_dynamics/step_scheduler.h"
#include "nodes/rod_dynamics/step_statistics.h"
#include "nodes/rod_dynamics/vessel_server_monitor.h"
#include "nodes/runtime/real_time.h"
#include "simulation/simulation.h"

namespace endovascular_sim::nodes
{

/** ROS node of the rod: one simulation step per slot of the steady clock, in lock-step with the contact node.
 *
 *  A late step starts at once, and the slots keep their times: the simulation catches up. Without a response of the
 *  contact node, steps use the stale contact set. After the parameter `pause_after` the simulation pauses and the
 *  rendered force ramps to zero. It continues, with new slots, at the next response. The node ends when vessel_server
 *  ends, because the deformed wall is lost with it. */
class RodDynamicsNode
{
public:
  /** @param parameters handle of the private parameters
   *  @param request requests the scheduling of the process; called after set-up */
  RodDynamicsNode(
      const ros::NodeHandle& node, const ros::NodeHandle& parameters, scene::Scene scene,
      std::function<SchedulingGrant()> request = [] { return SchedulingGrant(); });

  /** Runs until ROS shuts down or vessel_server ends, or for the parameter `seconds` of simulated time.
   *  @return false when ROS shut down before the first step */
  bool run();

private:
  using Clock = std::chrono::steady_clock;

  bool makeSimulation();
  bool waitForVessel(scene::EntryPose& entry, vessel::Vessel& vessel);
  void waitForRecorder() const;
  void runSteps(std::uint64_t last_step);
  void step();
  bool isOver();
  bool isContactLost() const;
  void pause();

  ros::NodeHandle node_;
  ros::NodeHandle parameters_;
  scene::Scene scene_;
  std::function<SchedulingGrant()> request_;
  SchedulingGrant grant_;
  double pause_after_;                             ///< silence of the contact node that causes a pause [s]
  double seconds_;                                 ///< simulated time until the end; 0: no end [s]
  std::unique_ptr<RemoteContactSource> contacts_;  ///< null without a vessel
  std::unique_ptr<VesselServerMonitor> server_;    ///< null without a vessel
  std::unique_ptr<RemoteDeformableWall> wall_;     ///< null without a vessel or without a balloon
  std::unique_ptr<simulation::Simulation> simulation_;
  std::unique_ptr<ProcedureDriver> procedure_;  ///< null without a procedure in the scene
  RodPublisher publisher_;
  RtThrottleGuard throttle_guard_;
  std::unique_ptr<ContactForcePublisher> forces_;  ///< null without a vessel
  DriveCommands drives_;
  InstrumentPublisher instruments_;
  HandForceRenderer renderer_;
  StepStatistics statistics_;
};

}  // namespace endovascular_sim::nodes
