#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include "endovascular_sim/SensorReading.h"
#include "endovascular_sim/SetFault.h"
#include "nodes/runtime/priority_inheritance_mutex.h"
#include "session/session.h"

namespace endovascular_sim::nodes
{

/** Sensors and faults of the robot in the graph: topics sensors/<name>, services instruments/<name>/fault. A recording
 *  holds the commands that the handles have followed, after all faults, so that its replay needs none of them. */
class GraphHardware
{
public:
  /** @param scene must outlive this object */
  GraphHardware(ros::NodeHandle& node, const scene::Scene& scene);
  ~GraphHardware() { spinner_.stop(); }
  GraphHardware(const GraphHardware&) = delete;
  GraphHardware& operator=(const GraphHardware&) = delete;

  /** Begins and ends faults as services have asked for, in the next step. */
  void applyChanges(session::Session& session);

  /** Publishes the samples that a step has delivered.
   *  @param stamp of the step */
  void publishStep(const session::Session& session, ros::Time stamp);

private:
  /** Call of a service. */
  struct Change
  {
    robot::FaultSettings fault;  ///< its times follow from the next step
    bool removes = false;
    double duration = 0.0;  ///< [s]; 0: no end
  };

  void advertiseFaults(ros::NodeHandle& node, std::size_t instrument);
  void setFault(std::size_t instrument, const SetFault::Request& request, SetFault::Response& response);
  void publish(std::size_t sensor, const session::Session& session, ros::Time stamp);

  const scene::Scene& scene_;
  std::vector<ros::Publisher> publishers_;  ///< one per sensor
  SensorReading message_;
  PriorityInheritanceMutex mutex_;  ///< guards the changes
  std::vector<Change> changes_;     ///< of services, which wait for the next step
  std::atomic<bool> has_changes_{false};
  ros::CallbackQueue queue_;  ///< of the services
  ros::AsyncSpinner spinner_{1, &queue_};
  std::vector<ros::ServiceServer> services_;  ///< last, so that they end first
};

}  // namespace endovascular_sim::nodes
