#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include "haptics/force/command_gate.h"
#include "nodes/runtime/direct_callback_queue.h"
#include "scene/model/scene.h"
#include "simulation/simulation.h"

namespace endovascular_sim::nodes
{

/** Commands of one servo_jp topic, for reports. */
struct TopicReport
{
  std::string topic;
  bool has_publisher = false;
  std::uint64_t accepted = 0;
  std::uint64_t malformed = 0;  ///< without positions of both joints, or with a pressure out of range
  haptics::RejectedCommands rejected;
  double silence = 0.0;  ///< simulated time since the last accepted command [s]
};

/** Commands to the instruments of a scene, each from its drive: a servo_jp topic, the scripted operator, or the profile
 *  in the scene. Commands of a topic pass a CommandGate. */
class DriveCommands
{
public:
  /** Subscribes to the topics of the instruments that are driven by a device or a topic.
   *  @param scene must outlive this object */
  DriveCommands(ros::NodeHandle& node, const scene::Scene& scene);

  /** Commands of the coming step, one per instrument.
   *  @param end simulated time at the end of the step [s]
   *  @param scripted commands of the scripted operator; null without one */
  const std::vector<simulation::HandCommand>& next(double end, const std::vector<simulation::HandCommand>* scripted);

  /** Reports of the topics, one per instrument that a topic drives. Callable from any thread. */
  std::vector<TopicReport> reports();

private:
  void subscribe(ros::NodeHandle& node, std::size_t instrument);
  void receive(std::size_t instrument, const sensor_msgs::JointState& message);

  const scene::Scene& scene_;
  std::vector<simulation::HandCommand> next_;  ///< commands of the coming step
  std::mutex mutex_;                           ///< guards the next three
  std::vector<haptics::CommandGate> gates_;    ///< one per instrument
  std::vector<double> pressures_;              ///< newest commanded pressure per instrument; NaN: none [Pa]
  std::vector<std::uint64_t> malformed_;       ///< messages without a command, per instrument
  DirectCallbackQueue queue_;
  std::vector<ros::Subscriber>
      subscribers_;  ///< one per instrument, empty without a topic; last, so that they end first
};

}  // namespace endovascular_sim::nodes
