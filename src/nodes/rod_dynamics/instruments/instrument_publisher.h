#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include "nodes/rod_dynamics/instruments/drive_commands.h"
#include "nodes/rod_dynamics/instruments/hand_force_renderer.h"
#include "simulation/contact_forces.h"
#include "simulation/simulation.h"

namespace endovascular_sim::nodes
{

/** Publisher of the CRTK topics of all instruments: joints at every step, tip and wall force with a subscriber, and
 *  operating states on change. */
class InstrumentPublisher
{
public:
  /** @param commands of the instruments; must outlive this object */
  InstrumentPublisher(ros::NodeHandle& node, const scene::Scene& scene, DriveCommands& commands);

  /** Publishes a step, and the operating states if they have changed.
   *  @param hands one per instrument */
  void publishStep(const simulation::Simulation& simulation, const std::vector<RenderedHand>& hands, ros::Time now);

  /** While the simulation is paused: publishes the commands of the last step with the rendered forces scaled by a
   *  share, and the operating states if they have changed. */
  void publishPaused(const std::vector<RenderedHand>& hands, double share, ros::Time now);

  /** Joints as on measured_js, after a step. */
  void measure(const simulation::Simulation& simulation, std::size_t instrument, sensor_msgs::JointState& joints) const;

  /** Begins a new run. */
  void reset();

  /** Sets the state of the simulation. Other than enabled, it is the state of all instruments.
   *  @param reason empty when enabled */
  void setSimulationState(drive::OperatingState state, const std::string& reason, ros::Time now);

private:
  /** Topics and last values of one instrument. */
  struct Channel
  {
    ros::Publisher measured, setpoint, goal, tip, wall_force, state, reason;
    bool has_balloon = false;
    simulation::HandState now, last;  ///< after the last step, and before it
    drive::HandCommand last_command;  ///< of the step before
    std::optional<drive::OperatingState> published_state;
    std::string published_reason;
    std::uint64_t revision = 0;
  };

  void publishMeasured(const simulation::Simulation& simulation, std::size_t k);
  void publishSetpoint(std::size_t k, const RenderedHand& hand, double share, bool moves);
  void publishGoals(const std::vector<RenderedHand>& hands);
  void publishTip(std::size_t k, const simulation::Simulation& simulation);
  void publishWallForce(std::size_t k, const simulation::Simulation& simulation);
  void publishStates();

  double time_step_;  ///< [s]
  DriveCommands& commands_;
  std::vector<Channel> channels_;
  bool has_last_ = false;  ///< true after the first step of a run
  drive::OperatingState simulation_state_ = drive::OperatingState::kEnabled;
  std::string simulation_reason_;
  std::uint64_t revision_ = ~std::uint64_t{0};  ///< of the commands at the last publication of states
  ros::Time now_;
  sensor_msgs::JointState joints_;
  geometry_msgs::PoseStamped pose_;
  geometry_msgs::WrenchStamped wrench_;
  std::vector<drive::HandCommand> used_, goals_;
  std::vector<simulation::WallContact> contacts_;
};

}  // namespace endovascular_sim::nodes
