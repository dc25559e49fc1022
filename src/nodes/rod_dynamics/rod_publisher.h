#pragma once

#include <string>

#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>

#include "endovascular_sim/DriveApplied.h"
#include "endovascular_sim/RodStateVisual.h"
#include "endovascular_sim/TreatmentVisual.h"
#include "sensor_msgs/JointState.h"
#include "simulation/simulation.h"

namespace endovascular_sim::nodes
{

/** Tells the graph what the rod did: every step the hand's force and the input used, 60 times a second the rest. */
class RodPublisher
{
public:
  RodPublisher(ros::NodeHandle& node, const scene::Scene& scene);

  /** What the hand on one instrument is told. */
  struct Hand
  {
    simulation::HandCommand command;  ///< that the last step used
    double force = 0.0;               ///< [N]
    double torque = 0.0;              ///< [N·m]
  };

  /** After a step: what the hands are told, its hash; now and then the pictures' data.
   *  @param hands one per instrument */
  void publishStep(const simulation::Simulation& simulation, const std::vector<Hand>& hands);

  /** Whether somebody listens to every step. */
  bool isRecorded() const { return applied_.getNumSubscribers() > 0; }

  /** What the hands are told alone, each time @p share of it (ramping down while the simulation is paused). */
  void publishHands(const std::vector<Hand>& hands, double share);

  /** CRTK's state of every instrument, latched; published when it changes.
   *  @param reason empty when enabled */
  void publishOperatingState(const std::string& state, const std::string& reason);

private:
  void publishVisual(const simulation::Simulation& simulation);
  void publishTreatment(const simulation::Simulation& simulation);
  void publishTip(const simulation::Simulation& simulation);

  std::uint64_t visual_every_;
  std::vector<ros::Publisher> hand_, operating_;  ///< per instrument
  std::vector<bool> has_balloon_;                 ///< per instrument
  ros::Publisher applied_, visual_, treatment_;
  tf2_ros::TransformBroadcaster transforms_;
  sensor_msgs::JointState hand_message_;
  DriveApplied applied_message_;
  RodStateVisual visual_message_;
  TreatmentVisual treatment_message_;
  std::string operating_state_;
};

}  // namespace endovascular_sim::nodes
