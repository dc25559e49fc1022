#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <ros/ros.h>

#include "nodes/rod_dynamics/control/pace.h"
#include "nodes/rod_dynamics/control/recorder_progress.h"
#include "nodes/rod_dynamics/control/rt_throttle_guard.h"
#include "nodes/rod_dynamics/control/simulation_services.h"
#include "nodes/rod_dynamics/control/step_observer.h"
#include "nodes/rod_dynamics/control/step_scheduler.h"
#include "nodes/rod_dynamics/graph_simulation.h"
#include "nodes/rod_dynamics/step_hold.h"
#include "nodes/rod_dynamics/step_obstacles.h"
#include "nodes/rod_dynamics/step_statistics.h"
#include "nodes/runtime/real_time.h"
#include "session/step_states.h"

namespace endovascular_sim::nodes
{

/** ROS node of the rod: takes the steps of the simulation at a pace, in lock-step with the contact node.
 *
 *  In real time a step begins with each slot of the steady clock. A late step starts at once, and the slots keep their
 *  times: the simulation catches up. Without a response of the contact node, steps use the stale contact set. After the
 *  parameter `pause_after` the simulation pauses and continues, with new slots, at the next response. A step that needs
 * the flow of blood is not taken before it has been computed. In the other paces the steps follow each other, or the
 * calls of simulation/step; they wait for the contact node, and for the recorder if it lags behind. Whenever no step is
 * taken, the rendered force ramps to zero. The node ends when vessel_server ends, because the deformed wall is lost
 * with it. */
class RodDynamicsNode
{
public:
  /** @param parameters handle of the private parameters
   *  @param request requests the scheduling of the process; called after set-up, in real time only */
  RodDynamicsNode(
      const ros::NodeHandle& node, const ros::NodeHandle& parameters, scene::Scene scene,
      std::function<SchedulingGrant()> request = [] { return SchedulingGrant(); });

  /** Runs until ROS shuts down or vessel_server ends, or for the parameter `seconds` of simulated time.
   *  @return false when ROS shut down before the first step */
  bool run();

private:
  using Clock = std::chrono::steady_clock;

  SimulationServices::Operations operations();
  void requestScheduling();
  void waitForRecorder() const;
  void runSteps();
  void step(StepScheduler& scheduler, Clock::time_point awake);
  bool isOver();
  bool isAtEnd() const { return simulation_.simulation().steps() >= last_step_; }

  void hold(const std::string& reason);
  void keepStepState();

  // Services.
  std::string pauseByClient();
  std::string resumeByClient();
  std::string reset();
  std::string goToStep(std::uint32_t number);
  std::string continueFrom(const std::string& state, const std::string& origin);
  void stepByClient(const StepSimulation::Request& request, StepSimulation::Response& response);
  std::string refusalOf(const StepSimulation::Request& request) const;
  std::string takeSteps(std::uint32_t steps);
  std::string waitForClearance();
  void continueRecording(ContinueRecording::Response& response);
  void announceRun(const std::string& state, std::uint64_t previous_steps);
  std::string beginRun(const std::string& state, std::uint64_t previous_steps);

  ros::NodeHandle node_;
  ros::NodeHandle parameters_;
  std::function<SchedulingGrant()> request_;
  SchedulingGrant grant_;
  Pace pace_;
  double seconds_;               ///< simulated time until the end; 0: no end [s]
  std::uint64_t last_step_ = 0;  ///< number of steps until the end
  GraphSimulation simulation_;
  RtThrottleGuard throttle_guard_;
  StepStatistics statistics_;
  RecorderProgress recorder_;
  ros::Publisher run_publisher_;
  std::uint32_t run_ = 0;        ///< number of the run
  std::uint64_t run_began_ = 0;  ///< number of steps before the first one of the run
  StepHold hold_;
  StepObstacles obstacles_;
  std::unique_ptr<StepObserver> observer_;
  session::StepStates step_states_;               ///< of a guided procedure
  std::unique_ptr<SimulationServices> services_;  ///< last, so that it ends before the members that it uses
};

}  // namespace endovascular_sim::nodes
