#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <tf2_ros/transform_broadcaster.h>

#include "endovascular_sim/DriveApplied.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "nodes/rod_dynamics/hand_force_renderer.h"
#include "simulation/simulation.h"

namespace endovascular_sim::nodes
{

/** Publisher of the rod's state: hand forces and used input at every step, data for display at about 60 Hz. */
class RodPublisher
{
public:
  RodPublisher(ros::NodeHandle& node, const scene::Scene& scene);

  /** Publishes a step: rendered forces, used input and state hash; at its rate also the data for display.
   *  @param hands one per instrument */
  void publishStep(const simulation::Simulation& simulation, const std::vector<RenderedHand>& hands);

  /** Reports whether drive/applied has a subscriber. */
  bool isRecorded() const { return applied_.getNumSubscribers() > 0; }

  /** Publishes the rendered forces only, scaled by a share; used while the simulation is paused. */
  void publishHands(const std::vector<RenderedHand>& hands, double share);

  /** Publishes the CRTK operating state of every instrument, latched, if it has changed.
   *  @param reason reason of the state; empty when enabled */
  void publishOperatingState(const std::string& state, const std::string& reason);

private:
  void publishVisual(const simulation::Simulation& simulation);
  void publishTreatment(const simulation::Simulation& simulation);
  void publishTip(const simulation::Simulation& simulation);

  std::uint64_t visual_period_;                   ///< interval of the data for display [steps]
  std::uint64_t last_step_;                       ///< last step of the scene's duration
  std::vector<ros::Publisher> hand_, operating_;  ///< one per instrument
  std::vector<bool> has_balloon_;                 ///< one per instrument
  ros::Publisher applied_, visual_, treatment_;
  tf2_ros::TransformBroadcaster transforms_;
  sensor_msgs::JointState hand_message_;
  DriveApplied applied_message_;
  RodStateVisual visual_message_;
  TreatmentVisual treatment_message_;
  std::string operating_state_;
};

}  // namespace endovascular_sim::nodes
