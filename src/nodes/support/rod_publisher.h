#pragma once

#include <string>

#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>

#include "endovascular_sim/DriveApplied.h"
#include "endovascular_sim/RodStateVisual.h"
#include "sensor_msgs/JointState.h"
#include "session/simulation.h"

namespace endovascular_sim::nodes
{

/** Tells the graph what the rod did: every step the hand's force and the input used, 60 times a second the rest. */
class RodPublisher
{
public:
  RodPublisher(ros::NodeHandle& node, const session::Scene& scene);

  /** After a step: force [N] and torque [N·m] for the hand and the command it used, its hash; now and then the
   *  pictures' data. */
  void publishStep(const session::Simulation& simulation, const session::HandCommand& command, double force,
                   double torque);

  /** Whether somebody listens to every step. */
  bool isRecorded() const { return applied_.getNumSubscribers() > 0; }

  /** Force and torque at the hand alone (ramping down while the simulation is paused) [N], [N·m]. */
  void publishHand(const session::HandCommand& command, double force, double torque);

  /** CRTK's state of the instrument, latched; published when it changes.
   *  @param reason empty when enabled */
  void publishOperatingState(const std::string& state, const std::string& reason);

private:
  void publishVisual(const session::Simulation& simulation);
  void publishTip(const session::Simulation& simulation);

  std::uint64_t visual_every_;
  ros::Publisher hand_, applied_, visual_, operating_;
  tf2_ros::TransformBroadcaster transforms_;
  sensor_msgs::JointState hand_message_;
  DriveApplied applied_message_;
  RodStateVisual visual_message_;
  std::string operating_state_;
};

}  // namespace endovascular_sim::nodes
