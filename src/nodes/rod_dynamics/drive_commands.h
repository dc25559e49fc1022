#pragma once

#include <mutex>
#include <vector>

#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include "nodes/runtime/direct_callback_queue.h"
#include "scene/model/scene.h"
#include "simulation/simulation.h"

namespace endovascular_sim::nodes
{

/** Commands to the instruments of a scene, each from its drive: a servo_jp topic, the scripted operator, or the profile
 *  in the scene. */
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

private:
  void subscribe(ros::NodeHandle& node, std::size_t instrument);
  void receive(std::size_t instrument, const sensor_msgs::JointState& message);

  const scene::Scene& scene_;
  std::vector<simulation::HandCommand> next_;  ///< commands of the coming step
  std::mutex mutex_;
  std::vector<simulation::HandCommand> received_;  ///< newest command per instrument; guarded
  DirectCallbackQueue queue_;
  std::vector<ros::Subscriber>
      subscribers_;  ///< one per instrument, empty without a topic; last, so that they end first
};

}  // namespace endovascular_sim::nodes
